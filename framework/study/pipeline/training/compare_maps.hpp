#pragma once

#include <filesystem>

#include "framework/study/pipeline/training/train_maps.hpp"

namespace twinmap {

/// What a comparison of maps looks at.
struct MapComparisonContext {
  MapTrainingContext training;
  Eigen::MatrixXd limit_stddev;  ///< p x n, of the test samples; empty where there is none
  std::filesystem::path folder;  ///< of the run; maps go to folder/maps
};

/// Maps on the same samples, with the warnings of the comparison.
struct ComparedMaps {
  std::vector<MapComparison> maps;
  StageNotes notes;
};

/// Trains each of ExperimentSpec::evaluation.maps on the training samples, infers the test samples with it
/// alone, and writes it to maps/NAME.h5, from which `infer` works. A map that cannot be trained is left out,
/// with a warning that says why. Throws Interrupted.
ComparedMaps compareMaps(const MapComparisonContext& context);

}  // namespace twinmap
