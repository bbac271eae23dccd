#pragma once

#include <string>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap::testing {

inline Expression ex(const std::string& text) {
  return {text, {}};
}
inline Name name(const std::string& text) {
  return {text, {}};
}
inline Expression3 ex3(const std::string& x, const std::string& y, const std::string& z) {
  return {ex(x), ex(y), ex(z)};
}

inline const Expression3 kOrigin = ex3("0", "0", "0");

inline ParameterSpec parameter(const std::string& text, double lower, double upper) {
  ParameterSpec spec;
  spec.name = name(text);
  spec.bounds.lower = lower;
  spec.bounds.upper = upper;
  return spec;
}

inline ConstantSpec constant(const std::string& text, const std::string& value) {
  ConstantSpec spec;
  spec.name = name(text);
  spec.value = ex(value);
  return spec;
}

inline JointSpec joint(JointType type, const std::vector<std::string>& coordinates,
                       const std::string& parent = "ground") {
  JointSpec spec;
  spec.type = type;
  spec.parent = name(parent);
  for (const std::string& coordinate : coordinates) {
    spec.coordinates.push_back(name(coordinate));
  }
  return spec;
}

inline JointSpec joint(JointType type, const Expression3& axis, const std::vector<std::string>& coordinates,
                       const std::string& parent = "ground") {
  JointSpec spec = joint(type, coordinates, parent);
  spec.axis = axis;
  return spec;
}

inline BodySpec body(const std::string& text, const std::string& mass, const Expression3& center_of_mass,
                     const Expression3& moments, const JointSpec& joint) {
  BodySpec spec;
  spec.name = name(text);
  spec.mass = ex(mass);
  spec.center_of_mass = center_of_mass;
  spec.inertia.moments = moments;
  spec.inertia.products = ex3("0", "0", "0");
  spec.joint = joint;
  return spec;
}

inline OutputSpec coordinateOutput(const std::string& text) {
  OutputSpec spec;
  spec.name = name(text);
  spec.coordinate = name(text);
  return spec;
}

inline OutputSpec speedOutput(const std::string& coordinate) {
  OutputSpec spec;
  spec.name = name(coordinate + "_speed");
  spec.speed = name(coordinate);
  return spec;
}

inline StationSpec station(const std::string& body, const Expression3& point) {
  return {name(body), point};
}

inline SignalSpec pulse(const std::string& text, const std::string& amplitude, const std::string& start,
                        const std::string& end) {
  SignalSpec spec;
  spec.name = name(text);
  spec.pulses.push_back({ex(amplitude), ex(start), ex(end)});
  return spec;
}

/// A force on a coordinate as a force law.
inline TableSpec tableOf(std::vector<double> times, std::vector<double> values,
                         TableInterpolation interpolation) {
  TableSpec table;
  table.times = std::move(times);
  table.values = std::move(values);
  table.interpolation = interpolation;
  return table;
}

inline ForceLaw<Expression> law(const std::string& coordinate, const std::string& force) {
  return {name(coordinate), ex(force)};
}

/// The initial coordinates as values.
inline NamedExpression value(const std::string& text, const std::string& number) {
  return {name(text), ex(number)};
}

}  // namespace twinmap::testing
