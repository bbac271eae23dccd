#pragma once

#include "framework/export/c_code/selftest.hpp"
#include "framework/export/model/exported_tracking.hpp"

namespace twinmap {

/// track_selftest.c: a life of estimates with the covariances of measurements of the run, and what `twinmap
/// track` believes behind each.
std::string makeTrackSelftest(const ExportedModel& model, const ExportedTracking& tracking,
                              const std::string& prefix, const std::vector<TestedMeasurement>& measurements);

}  // namespace twinmap
