#pragma once

#include <utility>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/models/mechanism/equations/element_values.hpp"
#include "framework/models/mechanism/equations/system_values.hpp"
#include "framework/models/mechanism/system_names.hpp"

namespace twinmap::equations {

template <class S>
Transform<S> calcFrame(const FrameSpec& frame, const NamedValues<S>& names) {
  return {rotateXyz(names.calc3(frame.orientation)), names.calc3(frame.point)};
}

template <class S>
Vec3<S> normalize(const Vec3<S>& a) {
  using namespace program::real;
  const S length = sqrt(dot(a, a));
  return {a.x / length, a.y / length, a.z / length};
}

/// Steiner's theorem.
template <class S>
Mat33<S> calcInertia(const BodySpec& spec, const NamedValues<S>& names, const S& mass,
                     const Vec3<S>& center) {
  const Vec3<S> moments = names.calc3(spec.inertia.moments), products = names.calc3(spec.inertia.products);
  const Mat33<S> own{{moments.x, products.x, products.y},
                     {products.x, moments.y, products.z},
                     {products.y, products.z, moments.z}};
  return own + scale(mass, makeDiagonal(dot(center, center)) - outer(center, center));
}

/// By default a slider moves along x, the others about z.
template <class S>
Vec3<S> calcAxis(const JointSpec& joint, const NamedValues<S>& names) {
  if (joint.axis) {
    return normalize(names.calc3(*joint.axis));
  }
  return getTraits(joint.type).axis == JointAxis::kX ? Vec3<S>{1.0, 0.0, 0.0} : Vec3<S>{0.0, 0.0, 1.0};
}

template <class S>
BodyValues<S> calcBody(const BodySpec& spec, const SystemNames& system, const NamedValues<S>& names) {
  BodyValues<S> body;
  body.parent = system.findBody(spec.joint.parent);
  body.type = spec.joint.type;
  body.axis = calcAxis(spec.joint, names);
  body.pitch = getTraits(spec.joint.type).has_pitch ? names.calc(spec.joint.pitch) : S(0.0);
  body.in_parent = calcFrame(spec.joint.in_parent, names);
  body.in_body = calcFrame(spec.joint.in_body, names);
  body.mass = names.calc(spec.mass);
  body.center = names.calc3(spec.center_of_mass);
  body.inertia = calcInertia(spec, names, body.mass, body.center);
  body.speed_count = getCoordinateCount(spec.joint.type);
  return body;
}

template <class S>
Station<S> calcStation(const StationSpec& spec, const SystemNames& system, const NamedValues<S>& names) {
  return {system.findBody(spec.body), names.calc3(spec.point)};
}

/// The conditions of a constraint. Those of coincident points are along the axes of a body that moves with
/// the loop: which of them are redundant in a planar loop then stays so while the loop as a whole turns.
template <class S>
void addClosures(const ConstraintSpec& spec, const SystemNames& system, const NamedValues<S>& names,
                 std::vector<Closure<S>>& closures) {
  Closure<S> closure;
  if (spec.coincident) {
    closure.kind = ClosureKind::kPlane;
    closure.from = calcStation(spec.coincident->from, system, names);
    closure.to = calcStation(spec.coincident->to, system, names);
    if (closure.from.body == 0) {
      std::swap(closure.from, closure.to);
    }
    for (const Vec3<S>& axis : {Vec3<S>{1.0, 0.0, 0.0}, Vec3<S>{0.0, 1.0, 0.0}, Vec3<S>{0.0, 0.0, 1.0}}) {
      closure.normal = axis;
      closures.push_back(closure);
    }
    return;
  }
  if (spec.rod) {
    closure.kind = ClosureKind::kRod;
    closure.from = calcStation(spec.rod->from, system, names);
    closure.to = calcStation(spec.rod->to, system, names);
    closure.length = names.calc(spec.rod->length);
  } else if (spec.point_in_plane) {
    closure.kind = ClosureKind::kPlane;
    closure.from = calcStation(spec.point_in_plane->plane.station, system, names);
    closure.to = calcStation(spec.point_in_plane->station, system, names);
    closure.normal = normalize(names.calc3(spec.point_in_plane->plane.normal));
  } else {
    closure.coordinate = system.findForcedCoordinate(spec.gear->coordinate);
    closure.driver = system.findForcedCoordinate(spec.gear->driver);
    closure.ratio = names.calc(spec.gear->ratio);
    closure.offset = names.calc(spec.gear->offset);
  }
  closures.push_back(closure);
}

/// Numbers without checks: those of a recorded program are symbols.
template <class S>
struct UncheckedNumbers {
  const NamedValues<S>& names;
  S calc(const Expression& expression, const std::string&, const char*, const char*) const {
    return names.calc(expression);
  }
};

/// Evaluates all numbers of a system, with all conditions of its constraints, redundant ones too. `names`:
/// parameters and constants.
template <class S>
SystemValues<S> calcSystemValues(const SystemSpec& spec, const SystemNames& system,
                                 const NamedValues<S>& names) {
  SystemValues<S> values;
  values.gravity = names.calc3(spec.gravity);
  values.bodies.emplace_back();
  for (const BodySpec& body : spec.bodies) {
    values.bodies.push_back(calcBody(body, system, names));
    values.bodies.back().first_speed = values.coordinate_count;
    values.coordinate_count += values.bodies.back().speed_count;
  }
  values.elements = calcElements<S>(spec.elements, system, UncheckedNumbers<S>{names},
                                    static_cast<int>(spec.states.size()));
  for (const ConstraintSpec& constraint : spec.constraints) {
    addClosures(constraint, system, names, values.closures);
  }
  values.state_count = static_cast<int>(system.getStateNames().size());
  return values;
}

}  // namespace twinmap::equations
