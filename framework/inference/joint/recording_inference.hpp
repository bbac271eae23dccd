#pragma once

#include <string>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// A recording by itself.
struct RecordingInference {
  std::string label;
  InferredMeasurement inferred;
  SimulatorPosterior posterior;  ///< that of `inferred`, of all its unknown parameters
};

}  // namespace twinmap
