#pragma once

#include <optional>

#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/training/train_surrogate_map.hpp"

namespace twinmap {

/// The number of training samples taken where it is automatic.
struct SampleChoice {
  int samples = 0;
  int simulated = 0;  ///< samples of both sets that the source did not have
  StageNotes notes;
  std::optional<PreparedData> data;              ///< of so many samples, where they were simulated
  std::optional<SurrogateMapTraining> training;  ///< on those; none where there is no surrogate
};

/// The most training samples that an experiment's design.train.time allows, at least 100. In lanes they take
/// next to nothing, so that times are not looked at and the number depends on no machine; of other simulators
/// the first two points are timed.
int limitByTime(const ExperimentSpec& experiment, Simulator& simulator);

/// For a study with an automatic number of training samples: trains surrogates on 100, 200, 400 ... samples,
/// the shorter set being the beginning of the longer one, until
/// - all parameters are near the limit, or from 100 on a doubling took their errors to no less than 0.7
///   (SimulationGain), by cross-validation;
/// - a surrogate of twice as many would take longer than design.train.time, at a nominal
///   speed (predicted by its size, the same on every machine);
/// - `most` are reached.
/// Where no surrogate can be trained, 250, which is what processes from features to parameters take. Tells
/// the log. Throws Interrupted, std::runtime_error as simulateSets() and trainSurrogateMap().
SampleChoice chooseTrainingSamples(const Study& study, int most);

}  // namespace twinmap
