#include "framework/experiment/check/field_check.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/joint_type.hpp"

namespace twinmap {
namespace {

void requireForced(const Coordinate& coordinate, const Name& name) {
  if (!coordinate.takes_forces) {
    throw ExperimentError(name.where, name.text,
                          "is an angle of a ball or free joint, whose speeds are an angular velocity; use a "
                          "bushing or an applied moment instead");
  }
}

}  // namespace

std::vector<Coordinate> collectCoordinates(const SystemSpec& system) {
  std::vector<Coordinate> coordinates;
  for (const BodySpec& body : system.bodies) {
    const JointCoordinates& expected = getJointCoordinates(body.joint.type);
    if (body.joint.coordinates.size() != expected.size()) {
      throw ExperimentError(
          body.name.where, body.name.text,
          fmt::format("has {} in joint.coordinates, of a joint with {} coordinate{}",
                      body.joint.coordinates.size(), expected.size(), expected.size() == 1 ? "" : "s"));
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      coordinates.push_back({body.joint.coordinates[i], getUnit(expected[i].kind), expected[i].takes_forces});
    }
  }
  return coordinates;
}

std::string makeRateUnit(const std::string& unit) {
  return unit.empty() ? "" : unit == "-" ? "1/s" : "(" + unit + ")/s";
}

const Coordinate& FieldCheck::find(const Name& name) const {
  std::vector<std::string> names;
  for (const Coordinate& coordinate : coordinates) {
    if (coordinate.name.text == name.text) {
      return coordinate;
    }
    names.push_back(coordinate.name.text);
  }
  requireKnown(name, names, "a coordinate");
  throw std::logic_error("a coordinate is known by name, but not listed");
}

void FieldCheck::check(const Expression& expression, const Unit& unit, bool on_angle) {
  if (!expression.text.empty()) {
    const CheckScope& scope = unit.varies ? dynamics : constants;
    scope.check(expression, unit.own ? own_unit : makeUnit(unit, on_angle));
  }
}

std::string FieldCheck::makeUnit(const Unit& unit, bool on_angle) {
  const std::string text = on_angle && unit.rotation != nullptr ? unit.rotation : unit.text;
  return unit.power == 1.0 ? text : std::isnan(unit.power) ? "" : text + "^" + toText(unit.power);
}

void FieldCheck::check(const Name& name, Reference reference) {
  switch (reference) {
    case Reference::kBody:
      return requireKnown(name, bodies, "a body or ground");
    case Reference::kEarlierBody:
      return requireKnown(name, bodies, "ground or a body declared before");
    case Reference::kForcedCoordinate:
      requireForced(find(name), name);
      [[fallthrough]];
    case Reference::kCoordinate:
      on_angle_ = find(name).unit != "m";
  }
}

}  // namespace twinmap
