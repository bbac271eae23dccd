#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/export/model/exported_model.hpp"
#include "framework/tracking/track_space.hpp"
#include "kernels/tracking/belief.hpp"
#include "kernels/tracking/model.hpp"

namespace twinmap {

/// How parameters move over time, as what leaves twinmap sees it.
struct ExportedTracking {
  TrackSpace space;
  TrackPrior prior;
  tracking::Model model;
  std::vector<std::string> conditions;  ///< columns whose means are given with a measurement
};

/// tracking: none: all parameters walk at unknown rates. Throws ExperimentError as checkTracking() does.
ExportedTracking makeExportedTracking(const std::optional<TrackingSpec>& tracking,
                                      const ExportedModel& model);

}  // namespace twinmap
