#include <algorithm>
#include <cmath>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/trim.hpp"
#include "framework/experiment/expression/units.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/tracking_spec.hpp"

namespace twinmap {
namespace {

const ParameterSpec& requireParameter(const Name& name, const ModelSpec& model) {
  std::vector<std::string> names;
  for (const ParameterSpec& parameter : model.parameters) {
    if (parameter.name.text == name.text) {
      return parameter;
    }
    names.push_back(parameter.name.text);
  }
  throw ExperimentError(name.where, name.text, "is not a parameter" + suggestName(name.text, names));
}

void requireUnknown(const std::optional<Name>& text) {
  if (text && text->text != "unknown") {
    throw ExperimentError(text->where, text->text, "must be unknown, or given in full");
  }
}

void requireWithin(const std::optional<double>& limit, const LimitSpec& limits,
                   const ParameterSpec& parameter) {
  if (limit && (*limit < parameter.bounds.lower || *limit > parameter.bounds.upper)) {
    throw ExperimentError(limits.name.where, toShortText(*limit, 6),
                          "is a limit outside the bounds of '" + parameter.name.text + "', " +
                              toShortText(parameter.bounds.lower, 6) + " .. " +
                              toShortText(parameter.bounds.upper, 6) + ", within which alone it is known");
  }
}

void checkSize(const ChangeSpec& change) {
  double size = 0.0;
  if (change.size && change.size->text != "unknown" &&
      (!parseLiteral(change.size->text, size) || !(size > 0.0))) {
    throw ExperimentError(change.size->where, change.size->text, "must be a number above 0, or unknown");
  }
}

}  // namespace

double readSpan(const Name& text) {
  const std::size_t end = text.text.find(' ');
  double number = 0.0;
  if (!parseLiteral(text.text.substr(0, end), number) || !(number > 0.0) || !std::isfinite(number)) {
    throw ExperimentError(text.where, text.text,
                          "must be a span of time: seconds above 0, or with a unit behind a blank, as 30 d");
  }
  return end == std::string::npos
             ? number
             : calcUnitConversion(text.text.substr(end + 1), "s", text.where).apply(number);
}

double readFalseAlarms(const Name& text) {
  constexpr double kRarest = 1e-6, kMost = 0.1;
  const std::size_t in = text.text.find(" in ");
  double number = 0.0, of = 1.0;
  const bool is_read = parseLiteral(text.text.substr(0, in), number) &&
                       (in == std::string::npos || parseLiteral(text.text.substr(in + 4), of));
  const double share = is_read ? number / of : 0.0;
  if (!(share >= kRarest && share <= kMost)) {
    throw ExperimentError(text.where, text.text, "must be a share from 1e-6 to 0.1, as 1 in 1000");
  }
  return share;
}

void checkTracking(const TrackingSpec& tracking, const ModelSpec& model) {
  for (const DriftSpec& drift : tracking.drift) {
    requireParameter(drift.name, model);
    requireUnknown(drift.trend);
    if (drift.random_walk) {
      requireUnknown(drift.random_walk->rate);
      drift.random_walk->over ? static_cast<void>(readSpan(*drift.random_walk->over)) : void();
    }
  }
  for (const FollowSpec& follow : tracking.follows) {
    requireParameter(follow.name, model);
  }
  for (const ChangeSpec& change : tracking.changes) {
    requireParameter(change.name, model);
    change.every ? static_cast<void>(readSpan(*change.every)) : void();
    checkSize(change);
  }
  for (const LimitSpec& limits : tracking.limits) {
    const ParameterSpec& parameter = requireParameter(limits.name, model);
    requireWithin(limits.min, limits, parameter);
    requireWithin(limits.max, limits, parameter);
  }
  readFalseAlarms(tracking.alarm.false_alarms);
}

}  // namespace twinmap
