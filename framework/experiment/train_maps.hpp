#pragma once

#include <filesystem>

#include "framework/experiment/prepare_data.hpp"
#include "framework/experiment/trained_map.hpp"
#include "framework/monitoring/run_control.hpp"

namespace twinmap {

/// What the training of a map looks at.
struct MapTrainingContext {
  const ExperimentSpec& experiment;
  const SimulatedSets& sets;
  const FeatureExtractor& extractor;
  const LabelledSets& labelled;
  const std::filesystem::path& folder;  ///< where maps.h5 is written
  const RunControl& control;
};

/// Trains the map that the experiment asks for, prepares it for measurements and writes maps.h5. Automatic is
/// a surrogate, and Gaussian processes from features to parameters where it cannot be trained: on eleven
/// mechanisms of different kinds the surrogate was the better map of 46 parameters of 48, with honest
/// standard deviations, in a tenth of the time (docs/maps.md). Throws Interrupted if it is stopped,
/// std::runtime_error where the experiment does not fit the map.
TrainedMap trainChosenMap(const MapTrainingContext& context);

}  // namespace twinmap
