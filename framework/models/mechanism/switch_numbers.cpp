#include "framework/models/mechanism/switch_numbers.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/element_values.hpp"

namespace twinmap {
namespace {

void requireBetween(const Expression& expression, const Quantity& quantity, double largest, const char* rule,
                    ModelNumbers& numbers) {
  const double value = numbers.calc(expression, quantity);
  if (value < 0.0 || value > largest) {
    throwUnusable(quantity, value, rule, expression.where);
  }
}

/// What depends on the state is not known yet.
void requireLevel(const Expression& level, const Quantity& quantity, ModelNumbers& numbers) {
  if (equations::usesOnly(numbers.getValues(), level)) {
    requireBetween(level, quantity, std::numeric_limits<double>::infinity(), "must not be negative", numbers);
  }
}

void checkPlay(const SystemSpec& system, ModelNumbers& numbers) {
  for (const Backlash<Expression>& backlash : system.elements.get<Backlash>()) {
    requireBetween(backlash.gap, {"backlash of '" + backlash.coordinate.text + "'", "gap", ""},
                   std::numeric_limits<double>::infinity(), "must not be negative", numbers);
  }
}

}  // namespace

void checkSwitchNumbers(const SystemSpec& system, ModelNumbers& numbers) {
  checkPlay(system, numbers);
  for (const Stop<Expression>& stop : system.elements.get<Stop>()) {
    if (stop.isRigid()) {
      requireBetween(*stop.restitution, {"stop on '" + stop.coordinate.text + "'", "restitution", ""}, 1.0,
                     "must be from 0 to 1", numbers);
    }
  }
  for (const Friction<Expression>& friction : system.elements.get<Friction>()) {
    if (friction.switches()) {
      const std::string owner = "friction on '" + friction.coordinate.text + "'";
      requireLevel(friction.coulomb, {owner, "coulomb", ""}, numbers);
      if (friction.stribeck) {
        requireLevel(friction.stribeck->level, {owner, "stribeck.level", ""}, numbers);
      }
    }
  }
}

void requireWithinStops(const SystemSpec& system, const SystemNames& names, ModelNumbers& numbers,
                        const Eigen::Ref<const Eigen::VectorXd>& coordinates) {
  constexpr double kRounding = 1e-12;  // as recordEvents() has it
  for (const Stop<Expression>& stop : system.elements.get<Stop>()) {
    if (!stop.isRigid()) {
      continue;
    }
    const std::string owner = "stop on '" + stop.coordinate.text + "'";
    const char* key = stop.above ? "above" : "below";
    const Expression& at = stop.above ? *stop.above : *stop.below;
    const double limit = numbers.calc(at, {owner, key, ""});
    const double other = stop.against ? coordinates[names.findCoordinate(*stop.against)] : 0.0;
    const double place = coordinates[names.findCoordinate(stop.coordinate)] - other;
    const double beyond = stop.above ? place - limit : limit - place;
    if (beyond > kRounding * (std::abs(place) + std::abs(limit))) {
      throw SimulationFailure(
          fmt::format("{}: the simulation starts at {:.6g}, beyond '{}: {:.6g}'; start on its free side",
                      owner, place, key, limit),
          at.where);
    }
  }
}

}  // namespace twinmap
