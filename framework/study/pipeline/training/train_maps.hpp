#pragma once

#include "framework/base/log/run_control.hpp"
#include "framework/study/pipeline/prepare_data.hpp"
#include "framework/study/pipeline/training/train_map.hpp"
#include "framework/study/pipeline/training/train_network.hpp"
#include "framework/study/pipeline/training/train_surrogate_map.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// What the training of a map looks at.
struct MapTrainingContext {
  const ExperimentSpec& experiment;
  const SimulatedSets& sets;
  const Simulator& simulator;
  const FeatureExtractor& extractor;
  const LabelledSets& labelled;
  const RunControl& control;
};

/// A map of processes, prepared for measurements.
TrainedMap makeTrainedMap(const MapTrainingContext& context, Training training);

/// Trains the map that the experiment asks for and prepares it for measurements. Automatic is
/// a surrogate, and Gaussian processes from features to parameters where it cannot be trained: on eleven
/// mechanisms of different kinds the surrogate was the better map of 52 parameters of 56, with calibrated
/// standard deviations, in a tenth of the time (docs/maps.md). Throws Interrupted if it is stopped,
/// std::runtime_error where the experiment does not fit the map.
TrainedMap trainChosenMap(const MapTrainingContext& context);

/// Prepares a surrogate for measurements that was trained on the context's samples.
TrainedMap makeTrainedMap(const MapTrainingContext& context, SurrogateMapTraining training);

}  // namespace twinmap
