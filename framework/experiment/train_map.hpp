#pragma once

#include "framework/features/labelled_features.hpp"
#include "framework/inverse_map/train_gp_map.hpp"
#include "framework/monitoring/run_control.hpp"
#include "framework/monitoring/stage_notes.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/spec/experiment_spec.hpp"

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
Training trainMap(const ExperimentSpec& experiment, const LabelledFeatures& samples,
                  const RunControl& control);

}  // namespace twinmap
