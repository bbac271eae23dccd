#include "framework/cli/commands/measurements/infer_history.hpp"

#include <algorithm>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap::cli {
namespace {

bool misleads(const std::string& status) {
  const std::vector<NoticeText>& notices = listNotices();
  return std::any_of(notices.begin(), notices.end(), [&](const NoticeText& notice) {
    return notice.is_status && notice.severity == Severity::kMisleading && status == notice.name;
  });
}

}  // namespace

void InferHistory::add(const InferredMeasurement& inferred) {
  const Estimate estimate = selectEstimate(inferred);
  if (!estimate.isGiven()) {
    return;
  }
  const Bounds95 bounds = estimate.calcBounds95();
  history_.points.push_back({inferred.source, inferred.start, joinStatuses(estimate.statuses, ", "),
                             std::none_of(estimate.statuses.begin(), estimate.statuses.end(), misleads),
                             estimate.mean, estimate.stddev, bounds.lower, bounds.upper});
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

ShownInference showInference(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters,
                             const std::vector<FeatureInfo>& features) {
  ShownInference shown{inferred.source, {}, parameters, {}, {}};
  std::istringstream trust(describeTrust(inferred, parameters, features) +
                           describeMapLimit(inferred, parameters));
  for (std::string line; std::getline(trust, line);) {
    shown.verdict.push_back(line);
  }
  const Estimate estimate = selectEstimate(inferred);
  if (!estimate.isGiven()) {
    return shown;
  }
  const Bounds95 bounds = estimate.calcBounds95();
  for (Eigen::Index p = 0; p < estimate.mean.size(); ++p) {
    shown.estimates.push_back({estimate.mean[p], estimate.stddev[p], bounds.lower[p], bounds.upper[p]});
  }
  const std::vector<DerivedValue> nuisance = listNuisance(inferred, estimate);
  for (std::size_t n = 0; n < nuisance.size(); ++n) {
    shown.parameters.push_back(inferred.nuisance[n]);
    shown.estimates.push_back(
        {nuisance[n].mean, nuisance[n].stddev, nuisance[n].lower95, nuisance[n].upper95});
  }
  return shown;
}

}  // namespace twinmap::cli
