#pragma once

#include "framework/base/log/stage_notes.hpp"
#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/preparation/study.hpp"
#include "framework/study/pipeline/training/train_network.hpp"
#include "framework/study/pipeline/training/train_surrogate_map.hpp"
#include "framework/study/pipeline/training/trained_map.hpp"

namespace twinmap {

/// A trained inverse map and how that went.
struct Training {
  GpMap map;
  TrainingSummary summary;
  StageNotes notes;
};

/// A map trained on samples and what its training reports tell.
Training makeTraining(const ExperimentSpec& experiment, const LabelledFeatures& samples,
                      GpMapTraining trained);

/// Trains the inverse map of an experiment on its training samples (trainGpMap). Throws Interrupted if it is
/// stopped, after one evaluation of the likelihood at most.
Training trainMap(const Study& study, const LabelledFeatures& samples);

/// A map of processes, prepared for measurements.
TrainedMap makeTrainedMap(const Study& study, const PreparedData& data, Training training);

/// Trains the map that the experiment asks for and prepares it for measurements. Automatic is
/// a surrogate, and Gaussian processes from features to parameters where it cannot be trained: on eleven
/// mechanisms of different kinds the surrogate was the better map of 52 parameters of 56, with calibrated
/// standard deviations, in a tenth of the time (docs/how-to/choose-an-estimator.md). Throws Interrupted if it
/// is stopped, std::runtime_error where the experiment does not fit the map.
TrainedMap trainChosenMap(const Study& study, const PreparedData& data);

/// "gp", "surrogate", ...: what an experiment asks for, which has a map.
const char* getEstimatorKind(const InverseMapSpec& spec);

/// Prepares a surrogate for measurements that was trained on these samples.
TrainedMap makeTrainedMap(const Study& study, const PreparedData& data, SurrogateMapTraining training);

}  // namespace twinmap
