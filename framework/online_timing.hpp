#pragma once

#include "framework/experiment.hpp"
#include "framework/features/labelled_features.hpp"
#include "framework/inverse_map/gp_map.hpp"

namespace twinmap {

/// Times the inference of all parameters from one feature vector at a time, in one thread, on the first (at
/// most 200) test samples, and notes the median and the 99 % quantile in the summary. For provenance.json
/// only: times are not reproducible.
void timeOnlineUpdates(const GpMap& map, const LabelledFeatures& testing, RunSummary& run);

}  // namespace twinmap
