#pragma once

#include <memory>
#include <optional>

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

/// A recording as a nuisance of its own explains it.
struct NuisanceFit {
  std::shared_ptr<const SimulatorRefiner> simulator;  ///< the sizes behind the model's unknown
  Eigen::VectorXd features;                           ///< NaN also where they cannot be simulated
  Eigen::VectorXd point;                              ///< of all that the simulator leaves unknown
  RecordingNuisance nuisance;                         ///< without its text
  std::string (*describe)(const std::vector<NuisanceSize>& sizes);
};

/// Fits one kind of nuisance to what the stated noise does not explain, from `best`, of all unknown
/// parameters, on. None where none leaves noise.
using NuisanceSearch = std::optional<NuisanceFit>(const RecordedSamples& recorded,
                                                  const Eigen::VectorXd& best);

}  // namespace twinmap
