#include "framework/tracking/track_answer.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "kernels/tracking/outlook.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// How far the parameter walks in an interval (unit: what its coordinate of 1 is in its unit).
Json makeWalk(const tracking::Tracker& tracker, Index parameter, double unit) {
  const tracking::TrackerState& state = tracker.getState();
  if (const tracking::RateFilters* filters = findFilters(state, parameter)) {
    const tracking::RateEstimate rate = estimateRate(calcRatePosterior(*filters));
    const double scale = unit * std::sqrt(state.variances[parameter]);
    return {{"sd", scale * rate.median},
            {"lower", scale * rate.lower},
            {"upper", scale * rate.upper},
            {"over", state.interval}};
  }
  return {{"sd", unit * std::sqrt(tracker.calcRates()[parameter] * state.interval)},
          {"over", state.interval}};
}

Json makeParameter(const TrackPoint& point, const tracking::Belief& belief, const TrackView& view, Index j) {
  const double mean = belief.mean[j], stddev = std::sqrt(belief.covariance(j, j));
  const double value = view.space.toValue(j, mean), unit = 1.0 / view.space.calcSlope(j, value);
  Json json{{"mean", value},
            {"sd", unit * stddev},
            {"lower", view.space.toValue(j, mean - kNormal95 * stddev)},
            {"upper", view.space.toValue(j, mean + kNormal95 * stddev)},
            {"unit", view.parameters[static_cast<std::size_t>(j)].unit},
            {"walk", makeWalk(point.tracker, j, unit)}};
  if (const Index slope = findSlope(point.tracker.getModel(), j); slope >= 0) {
    json["slope"] = {{"mean", unit * belief.mean[slope]},
                     {"sd", unit * std::sqrt(belief.covariance(slope, slope))}};
  }
  return json;
}

Json makeCovariance(const tracking::Belief& belief, const TrackView& view) {
  const Index p = view.space.count();
  VectorXd units(p);
  for (Index j = 0; j < p; ++j) {
    units[j] = 1.0 / view.space.calcSlope(j, view.space.toValue(j, belief.mean[j]));
  }
  Json rows = Json::array();
  for (Index i = 0; i < p; ++i) {
    const VectorXd row = units[i] * units.cwiseProduct(belief.covariance.row(i).head(p).transpose());
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

Json makeFollows(const TrackPoint& point, const tracking::Belief& belief, const TrackView& view) {
  Json list = Json::array();
  const tracking::Model& model = point.tracker.getModel();
  Index place = model.countParameters() + model.countSlopes();
  for (const FollowSpec& follow : view.tracking->follows) {
    for (const Name& condition : follow.conditions) {
      const Index j =
          model.follows[static_cast<std::size_t>(place - model.countParameters() - model.countSlopes())]
              .parameter;
      const double unit = 1.0 / view.space.calcSlope(j, view.space.toValue(j, belief.mean[j]));
      list.push_back({{"parameter", follow.name.text},
                      {"condition", condition.text},
                      {"coefficient", unit * belief.mean[place]},
                      {"sd", unit * std::sqrt(belief.covariance(place, place))}});
      ++place;
    }
  }
  return list;
}

/// A time, or null of never.
Json makeTime(double now, double later) {
  return std::isfinite(later) ? Json(now + later) : Json();
}

Json makeForecast(const TrackPoint& point, const TrackView& view) {
  constexpr double kIntervals = 1000.0;  // farther than any rate is known
  Json list = Json::array();
  const tracking::TrackerState& state = point.tracker.getState();
  for (const LimitSpec& limits : view.tracking->limits) {
    const auto named =
        std::find_if(view.parameters.begin(), view.parameters.end(),
                     [&](const ParameterSpec& one) { return one.name.text == limits.name.text; });
    const Index j = named - view.parameters.begin();
    const tracking::Outlook outlook = calcOutlook(point.tracker, j);
    for (const bool is_min : {true, false}) {
      const std::optional<double>& limit = is_min ? limits.min : limits.max;
      if (!limit || !(state.interval > 0.0)) {
        continue;
      }
      const tracking::Crossing crossing =
          findCrossing(outlook, view.space.toCoordinate(j, *limit), is_min, kIntervals * state.interval);
      list.push_back({{"parameter", limits.name.text},
                      {is_min ? "min" : "max", *limit},
                      {"median", makeTime(state.time, crossing.median)},
                      {"lower", makeTime(state.time, crossing.lower)},
                      {"upper", makeTime(state.time, crossing.upper)}});
    }
  }
  return list;
}

}  // namespace

Json makeTrackState(const TrackPoint& point, const TrackView& view) {
  constexpr double kRemembered = 20.0;  // measurements
  const tracking::TrackerState& state = point.tracker.getState();
  const tracking::Belief belief = point.tracker.calcBelief();
  const bool is_uncalibrated =
      point.uncalibrated_at >= 0.0 && static_cast<double>(state.count) - point.uncalibrated_at < kRemembered;
  Json json{{"measurements", state.count},
            {"time", state.time},
            {"status", is_uncalibrated ? "uncalibrated" : "ok"},
            {"alarm_count", point.alarm_count}};
  for (Index j = 0; j < view.space.count(); ++j) {
    json["parameters"][view.parameters[static_cast<std::size_t>(j)].name.text] =
        makeParameter(point, belief, view, j);
  }
  json["covariance"] = makeCovariance(belief, view);
  if (view.tracking != nullptr && !view.tracking->follows.empty()) {
    json["follows"] = makeFollows(point, belief, view);
  }
  if (view.tracking != nullptr && !view.tracking->limits.empty()) {
    json["forecast"] = makeForecast(point, view);
  }
  return json;
}

namespace {

/// What the change may be in its place, and the measurement that would tell.
Json makeVerdict(const TrackAlarm& alarm, const TrackView& view) {
  const std::deque<AlarmDiagnosis> none, &all = view.diagnoses != nullptr ? *view.diagnoses : none;
  const auto diagnosis =
      std::find_if(all.begin(), all.end(), [&](const AlarmDiagnosis& one) { return one.isOf(alarm); });
  const Json held = diagnosis == all.end() ? Json::object() : parseJson(diagnosis->answer);
  const std::string term = held.value("term", "");
  std::vector<std::string> rivals = alarm.rivals;
  if (!term.empty()) {
    rivals.push_back(term);
  }
  Json verdict{{"rivals", rivals}};
  if (!rivals.empty()) {
    verdict["test"] = fmt::format(
        "measure again with {} as it was before the change: what is then as it was follows it, and the model "
        "lacks {}",
        alarm.rivals.empty() ? "the motion" : fmt::format("{}", fmt::join(alarm.rivals, ", ")),
        term.empty() ? "a term" : term);
  }
  if (!held.empty()) {
    verdict["diagnosis"] = held;
  }
  return verdict;
}

Json makeAlarm(const TrackAlarm& alarm, const TrackView& view) {
  const tracking::Change& change = alarm.change;
  if (alarm.is_of_several) {
    return {{"announced", alarm.announced},
            {"parameter", nullptr},
            {"of", "several parameters at once"},
            {"time", change.time},
            {"drift_or_model", makeVerdict(alarm, view)}};
  }
  const auto& parameter = view.parameters[static_cast<std::size_t>(change.parameter)];
  const Bounds& bounds = parameter.bounds;
  const double unit = 1.0 / view.space.calcSlope(change.parameter, 0.5 * (bounds.lower + bounds.upper));
  Json json{{"announced", alarm.announced},
            {"parameter", parameter.name.text},
            {"probability", change.probability},
            {"time", change.time},
            {"time_interval", {change.earliest, change.latest}},
            {"size", unit * change.size},
            {"sd", unit * change.stddev},
            {"unit", parameter.unit}};
  for (std::size_t j = 0; j < view.parameters.size(); ++j) {
    json["probabilities"][view.parameters[j].name.text] = change.probabilities[static_cast<Index>(j)];
  }
  json["drift_or_model"] = makeVerdict(alarm, view);
  return json;
}

}  // namespace

Json makeTrackAlarms(const TrackPoint& point, long long skipped, const TrackView& view) {
  Json list = Json::array();
  const auto kept = static_cast<long long>(point.alarms.size());
  const long long first = std::max(0LL, kept - (point.alarm_count - skipped));
  for (long long i = first; i < kept; ++i) {
    list.push_back(makeAlarm(point.alarms[static_cast<std::size_t>(i)], view));
  }
  return list;
}

}  // namespace twinmap
