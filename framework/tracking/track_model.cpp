#include "framework/tracking/track_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Eigen::Index findPlace(const std::string& name, const ModelSpec& model) {
  const auto found =
      std::find_if(model.parameters.begin(), model.parameters.end(),
                   [&](const ParameterSpec& parameter) { return parameter.name.text == name; });
  return found - model.parameters.begin();
}

/// Of the coordinate at the middle of the bounds, where a standard deviation is given in the parameter's
/// unit.
double toCoordinates(double stddev, Eigen::Index parameter, const ModelSpec& model, const TrackSpace& space) {
  const Bounds& bounds = model.parameters[static_cast<std::size_t>(parameter)].bounds;
  return stddev * space.calcSlope(parameter, 0.5 * (bounds.lower + bounds.upper));
}

double calcRate(const DriftSpec& drift, Eigen::Index parameter, const ModelSpec& model,
                const TrackSpace& space) {
  if (!drift.random_walk || drift.random_walk->rate) {
    return kUnknown;
  }
  const double stddev = toCoordinates(*drift.random_walk->stddev, parameter, model, space);
  return stddev * stddev / readSpan(*drift.random_walk->over);
}

/// Weights of what has no stated span are those of the rarest that has one.
void weighChanges(const TrackingSpec& tracking, const ModelSpec& model, const TrackSpace& space,
                  std::vector<tracking::Drift>& drifts) {
  double longest = 0.0;
  for (const ChangeSpec& change : tracking.changes) {
    longest = change.every ? std::max(longest, readSpan(*change.every)) : longest;
  }
  for (const ChangeSpec& change : tracking.changes) {
    const Eigen::Index place = findPlace(change.name.text, model);
    tracking::Drift& drift = drifts[static_cast<std::size_t>(place)];
    double size = 0.0;
    if (change.size && parseLiteral(change.size->text, size)) {
      drift.change_stddev = toCoordinates(size, place, model, space);
    }
    drift.change_weight = change.every ? longest / readSpan(*change.every) : 1.0;
  }
}

}  // namespace

std::vector<std::string> listConditions(const TrackingSpec& tracking) {
  std::vector<std::string> names;
  for (const FollowSpec& follow : tracking.follows) {
    for (const Name& condition : follow.conditions) {
      if (std::find(names.begin(), names.end(), condition.text) == names.end()) {
        names.push_back(condition.text);
      }
    }
  }
  return names;
}

tracking::Model makeTrackModel(const TrackingSpec* tracking, const ModelSpec& model, const TrackSpace& space,
                               const Eigen::VectorXd& shared_error) {
  tracking::Model made;
  const tracking::Belief prior = makeTrackPrior(model, space).belief;
  made.mean = prior.mean;
  made.covariance = prior.covariance;
  made.drifts.resize(model.parameters.size());
  for (Eigen::Index j = 0; j < shared_error.size(); ++j) {
    made.drifts[static_cast<std::size_t>(j)].shared_error = shared_error[j];
  }
  if (tracking == nullptr) {
    for (tracking::Drift& drift : made.drifts) {
      drift.rate = kUnknown;
    }
    return made;
  }
  for (const DriftSpec& drift : tracking->drift) {
    const Eigen::Index place = findPlace(drift.name.text, model);
    tracking::Drift& one = made.drifts[static_cast<std::size_t>(place)];
    one.rate = calcRate(drift, place, model, space);
    one.has_slope = drift.trend.has_value();
  }
  const std::vector<std::string> conditions = listConditions(*tracking);
  made.conditions = static_cast<Eigen::Index>(conditions.size());
  for (const FollowSpec& follow : tracking->follows) {
    for (const Name& condition : follow.conditions) {
      const auto place = std::find(conditions.begin(), conditions.end(), condition.text) - conditions.begin();
      made.follows.push_back({findPlace(follow.name.text, model), place, 0.0});
    }
  }
  weighChanges(*tracking, model, space, made.drifts);
  made.false_alarms = readFalseAlarms(tracking->alarm.false_alarms);
  return made;
}

}  // namespace twinmap
