#pragma once

#include "framework/base/log/stage_notes.hpp"
#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/study.hpp"

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

}  // namespace twinmap
