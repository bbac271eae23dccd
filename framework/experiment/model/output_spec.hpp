#pragma once

#include <optional>

#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/model/elements/element.hpp"
#include "framework/experiment/model/sensor_spec.hpp"

namespace twinmap {

/// A position, velocity or acceleration of a station, in the ground frame, along `direction` (normalised).
struct StationOutputSpec {
  StationSpec station;
  Expression3 direction;
};

template <class Fields>
void describe(Fields& f, StationOutputSpec& s) {
  f.required("body", s.station.body, "a body", Reference::kBody);
  f.optional("point", s.station.point, "in the body's frame", Unit{"m"});
  f.required("direction", s.direction, "in the ground frame; normalised", kNoUnit);
}

/// A vector that a sensor on a body measures at `point`, along `direction` in the body's frame (normalised).
struct BodySensorSpec {
  StationSpec station;
  Expression3 direction;
};

template <class Fields>
void describe(Fields& f, BodySensorSpec& s) {
  f.required("body", s.station.body, "a body", Reference::kBody);
  f.optional("point", s.station.point, "in the body's frame", Unit{"m"});
  f.required("direction", s.direction, "in the body's frame; normalised", kNoUnit);
}

/// A part of a force: along the axes of the frame that goes with it.
enum class ForceComponent { kForceX, kForceY, kForceZ, kMomentX, kMomentY, kMomentZ };

template <>
struct EnumNames<ForceComponent> {
  static constexpr EnumName<ForceComponent> values[] = {
      {"force_x", ForceComponent::kForceX},   {"force_y", ForceComponent::kForceY},
      {"force_z", ForceComponent::kForceZ},   {"moment_x", ForceComponent::kMomentX},
      {"moment_y", ForceComponent::kMomentY}, {"moment_z", ForceComponent::kMomentZ}};
};

constexpr bool isMoment(ForceComponent component) {
  return component >= ForceComponent::kMomentX;
}
constexpr const char* getForceUnit(ForceComponent component) {
  return isMoment(component) ? "N m" : "N";
}
/// 0 to 2: x, y, z.
constexpr int getAxis(ForceComponent component) {
  return static_cast<int>(component) % 3;
}

/// What a joint exerts on its body, the child, at the joint's frame there and in the axes of the parent: all
/// that passes from the parent to the child, forces on the joint's coordinates included.
struct ReactionSpec {
  Name joint;
  ForceComponent component = ForceComponent::kForceX;
};

template <class Fields>
void describe(Fields& f, ReactionSpec& s) {
  f.required("joint", s.joint, "name of a joint, or of its body where the joint has none");
  f.required("component", s.component, "on the child body, in the axes of the parent");
}

/// One measured quantity of the system: gain * quantity + offset; exactly one of the optional members is set.
/// Speeds are time derivatives of coordinates.
struct OutputSpec {
  Name name;
  std::optional<Name> coordinate;
  std::optional<Name> speed;
  std::optional<StationOutputSpec> position;
  std::optional<StationOutputSpec> velocity;
  std::optional<StationOutputSpec> acceleration;
  std::optional<BodySensorSpec> specific_force;    ///< acceleration less gravity
  std::optional<BodySensorSpec> angular_velocity;  ///< whatever the point
  std::optional<ReactionSpec> reaction;
  std::optional<Name> force_of;  ///< a named force element or constraint, a coordinate that is moved
  std::optional<ForceComponent> component;  ///< of force_of; none: along its coordinate, line or normal
  Expression expression{"", {}};
  std::optional<Name> variable;
  std::string unit;           ///< of a variable or an expression
  Expression gain{"", {}};    ///< of the sensor, dimensionless; 1 if not given
  Expression offset{"", {}};  ///< of the sensor, in the quantity's unit; 0 if not given
  std::optional<SensorSpec> sensor;
};

template <class Fields>
void describe(Fields& f, OutputSpec& s) {
  f.oneOf(
      "must give exactly one of",
      choice("coordinate", s.coordinate, "a joint coordinate; m or rad", Reference::kCoordinate),
      choice("speed", s.speed, "time derivative of a joint coordinate; m/s or rad/s", Reference::kCoordinate),
      choice("position", s.position, "of a station, along a direction; m"),
      choice("velocity", s.velocity, "of a station, along a direction; m/s"),
      choice("acceleration", s.acceleration, "of a station, along a direction; m/s2"),
      choice("specific_force", s.specific_force,
             "what an accelerometer on a body reads, along a direction; m/s2"),
      choice("angular_velocity", s.angular_velocity,
             "what a gyroscope on a body reads, along a direction; rad/s"),
      choice("reaction", s.reaction, "force or moment in a joint; N or N m"),
      choice("force_of", s.force_of,
             "of a named force element or constraint, or of what moves a coordinate in 'motions'; N or N m"),
      choice("expression", s.expression,
             "of coordinates, speeds, accelerations (<coordinate>_ddot), states and signals",
             Unit{"", nullptr, true, true}),
      choice("variable", s.variable, "of an FMU or a program"));
  f.optional("component", s.component,
             "of force_of, on 'body' or 'to' in ground axes; default: the force on its coordinate, the pull "
             "between its points or the pressure on its plane");
  f.optional("unit", s.unit, "coherent SI unit of a variable or an expression");
  f.optional("gain", s.gain, "of the sensor, which measures gain * quantity + offset; default 1", Unit{"1"});
  f.optional("offset", s.offset, "of the sensor, in the quantity's unit; default 0", kOwnUnit);
  f.optional("sensor", s.sensor, "that lags, filters, averages, delays, clips or rounds");
  f.rule(s.expression.text.empty() || !s.unit.empty(),
         "must give the unit of the expression in 'unit' (1 where it has none)");
  f.rule(s.force_of || !s.component, "must give 'component' beside 'force_of' alone; a reaction has its own");
}

}  // namespace twinmap
