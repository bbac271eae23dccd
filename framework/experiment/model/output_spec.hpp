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
      choice("expression", s.expression,
             "of coordinates, speeds, accelerations (<coordinate>_ddot), states and signals",
             Unit{"", nullptr, true, true}),
      choice("variable", s.variable, "of an FMU or a program"));
  f.optional("unit", s.unit, "coherent SI unit of a variable or an expression");
  f.optional("gain", s.gain, "of the sensor, which measures gain * quantity + offset; default 1", Unit{"1"});
  f.optional("offset", s.offset, "of the sensor, in the quantity's unit; default 0", kOwnUnit);
  f.optional("sensor", s.sensor, "that lags, filters, averages, delays, clips or rounds");
  f.rule(s.expression.text.empty() || !s.unit.empty(),
         "must give the unit of the expression in 'unit' (1 where it has none)");
}

}  // namespace twinmap
