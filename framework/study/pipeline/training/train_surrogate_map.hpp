#pragma once

#include "framework/estimation/surrogate/surrogate.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

/// A trained surrogate and how that went.
struct SurrogateMapTraining {
  Surrogate surrogate;
  Eigen::VectorXd typical_stddev;  ///< p: calcTypicalStddev() of what it infers, in the parameters' units
  TrainingSummary summary;         ///< its left-out samples are those of the cross-validation
  StageNotes notes;
};

/// Trains a surrogate (trainSurrogate) on the clean training responses of an experiment; the labelled
/// features' draws of the noise are what it infers in cross-validation. Where the simulator has exact
/// derivatives, those at the training points are simulated and learnt from. Throws Interrupted if it is
/// stopped, std::runtime_error where the experiment does not fit it: a feature without noise, too few
/// samples.
SurrogateMapTraining trainSurrogateMap(const Study& study, const PreparedData& data);

}  // namespace twinmap
