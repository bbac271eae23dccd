#pragma once

#include "framework/experiment.hpp"
#include "framework/features/labelled_features.hpp"
#include "framework/online/online_model.hpp"

namespace twinmap {

/// Times the inference of all parameters from one feature vector at a time and its judgement, in one thread,
/// on the first (at most 200) test samples, and notes the median and the 99 % quantile in the summary. For
/// provenance.json only: times are not reproducible.
void timeOnlineUpdates(const OnlineModel& model, const LabelledFeatures& testing, RunSummary& run);

}  // namespace twinmap
