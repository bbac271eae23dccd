#pragma once

#include "framework/inference/refiner.hpp"

namespace twinmap {

/// What a recording is inferred from.
struct RecordedSamples {
  const ExperimentSpec& experiment;  ///< of a system that it describes; all features are samples
  const ResponseLayout& layout;
  const Eigen::VectorXd& features;  ///< d, NaN where missing
  const Eigen::VectorXd& known;
  const NoiseHypothesis& noise;  ///< as it is stated
};

}  // namespace twinmap
