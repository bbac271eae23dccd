#pragma once

#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/results/run_summary.hpp"

namespace twinmap {

/// Times the inference of all parameters from one feature vector at a time and its judgement, in one thread,
/// on the first (at most 200) test samples: median and 99 % quantile. For provenance.json only: times are not
/// reproducible.
OnlineTimes timeOnlineUpdates(const OnlineModel& model, const LabelledFeatures& testing);

}  // namespace twinmap
