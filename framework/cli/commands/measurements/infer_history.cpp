#include "framework/cli/commands/measurements/infer_history.hpp"

#include <algorithm>

#include "framework/base/log/notice.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap::cli {
namespace {

/// Windows that disagree count: their standard deviations have the scatter.
bool counts(std::vector<std::string> statuses) {
  statuses.erase(
      std::remove(statuses.begin(), statuses.end(), std::string(getNotice(Notice::kTrialsDisagree).name)),
      statuses.end());
  return !misleads(statuses);
}

}  // namespace

void InferHistory::add(const InferredMeasurement& inferred) {
  const Estimate estimate = selectEstimate(inferred);
  if (!estimate.isGiven()) {
    return;
  }
  const Bounds95 bounds = estimate.calcBounds95();
  history_.points.push_back({inferred.source, inferred.start, joinStatuses(estimate.statuses, ", "),
                             counts(estimate.statuses), estimate.mean, estimate.stddev, bounds.lower,
                             bounds.upper});
  if (!inferred.posterior) {
    return;
  }
  for (const Profile& profile : inferred.posterior->profiles) {
    const auto parameter = static_cast<std::size_t>(profile.parameter);
    if (parameter < history_.parameters.size()) {  // a nuisance parameter has no place on the page
      history_.points.back().profiles.push_back(
          {parameter, profile.points.row(profile.parameter), profile.log_ratios});
    }
  }
}

}  // namespace twinmap::cli
