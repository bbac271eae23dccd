#pragma once

#include "framework/study/pipeline/training/train_maps.hpp"

namespace twinmap {

/// Maps on the same samples, with the warnings of the comparison.
struct ComparedMaps {
  std::vector<MapComparison> maps;
  StageNotes notes;
};

/// Trains each of ExperimentSpec::evaluation.maps on the training samples, infers the test samples with it
/// alone, and writes it to maps/NAME.h5, from which `infer` works. A map that cannot be trained is left out,
/// with a warning that says why. `limit_stddev`: p x n, of the test samples; empty where there is none.
/// Throws Interrupted.
ComparedMaps compareMaps(const Study& study, const PreparedData& data, const Eigen::MatrixXd& limit_stddev);

}  // namespace twinmap
