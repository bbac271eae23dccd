#pragma once

#include <utility>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/models/mechanism/element_values.hpp"
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
  const Vec3<S> moments = names.calc3(getMoments(spec.inertia)),
                products = names.calc3(spec.inertia.products);
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

/// A point of two bodies along the axes of one of them: of a body that moves with the loop, so that what is
/// redundant in a planar loop stays so while the loop as a whole turns.
template <class S>
void addCoincidence(const Station<S>& from, const Station<S>& to, const Mat33<S>& axes, int constraint,
                    std::vector<Closure<S>>& closures) {
  Closure<S> closure;
  closure.kind = ClosureKind::kPlane;
  closure.constraint = constraint;
  closure.from = from;
  closure.to = to;
  for (const Vec3<S>& axis : {axes.x, axes.y, axes.z}) {
    closure.normal = axis;
    closures.push_back(closure);
  }
}

/// The conditions of two coincident frames (weld), or of their origins and z axes (pin). Of the orientations
/// that differ by half turns, which meet them too, the start decides.
template <class S>
void addFrames(const AttachedFrameSpec& from_spec, const AttachedFrameSpec& to_spec, bool weld,
               const SystemNames& system, const NamedValues<S>& names, Closure<S> closure,
               std::vector<Closure<S>>& closures) {
  Transform<S> from = calcFrame(from_spec.frame, names), to = calcFrame(to_spec.frame, names);
  int from_body = system.findBody(from_spec.body), to_body = system.findBody(to_spec.body);
  closure.swapped = from_body == 0;
  if (closure.swapped) {
    std::swap(from, to);
    std::swap(from_body, to_body);
  }
  const std::size_t first = closures.size();
  addCoincidence<S>({from_body, from.origin}, {to_body, to.origin}, from.rotation, closure.constraint,
                    closures);
  closure.kind = ClosureKind::kPerpendicular;
  closure.from = {from_body, from.origin};
  closure.to = {to_body, to.origin};
  const auto add = [&](const Vec3<S>& normal, const Vec3<S>& across) {
    closure.normal = normal;
    closure.across = across;
    closures.push_back(closure);
  };
  if (weld) {
    add(from.rotation.x, to.rotation.y);
    add(from.rotation.y, to.rotation.z);
    add(from.rotation.z, to.rotation.x);
  } else {
    add(from.rotation.x, to.rotation.z);
    add(from.rotation.y, to.rotation.z);
  }
  for (std::size_t i = first; i < closures.size(); ++i) {
    closures[i].swapped = closure.swapped;
  }
}

/// Two unit vectors at right angles to a unit vector n and to each other (Duff and others, J. Computer
/// Graphics Techniques 6, 2017, p. 1).
template <class S>
std::pair<Vec3<S>, Vec3<S>> calcPlaneDirections(const Vec3<S>& n) {
  using namespace program::real;
  const S one = 1.0, sign = select(less(n.z, S(0.0)), S(-one), one);
  const S a = S(-1.0) / (sign + n.z), b = n.x * n.y * a;
  return {{one + sign * n.x * n.x * a, sign * b, S(-sign * n.x)}, {b, sign + n.y * n.y * a, S(-n.y)}};
}

/// The center keeps the radius from the plane, and nothing slips along the plane's two directions.
template <class S>
void addRolling(const RollingSpec& spec, const SystemNames& system, const NamedValues<S>& names,
                Closure<S> closure, std::vector<Closure<S>>& closures) {
  const Vec3<S> point = names.calc3(spec.plane.point);
  closure.normal = normalize(names.calc3(spec.plane.normal));
  closure.length = names.calc(spec.radius);
  closure.kind = ClosureKind::kPlane;
  closure.from = {system.findBody(spec.plane.body), point + scale(closure.length, closure.normal)};
  closure.to = calcStation(spec.center, system, names);
  closures.push_back(closure);
  closure.kind = ClosureKind::kRolling;
  closure.from.point = point;
  const auto [first, second] = calcPlaneDirections(closure.normal);
  for (const Vec3<S>& direction : {first, second}) {
    closure.across = direction;
    closures.push_back(closure);
  }
}

template <class S>
void addGear(const GearSpec& gear, const SystemNames& system, const NamedValues<S>& names, Closure<S> closure,
             std::vector<Closure<S>>& closures) {
  closure.coordinate = system.findForcedCoordinate(gear.coordinate);
  closure.driver = system.findForcedCoordinate(gear.driver);
  closure.ratio = names.calc(gear.ratio);
  closure.offset = names.calc(gear.offset);
  closures.push_back(closure);
}

/// The conditions of a constraint, the file's `place`-th.
template <class S>
void addClosures(const ConstraintSpec& spec, int place, const SystemNames& system,
                 const NamedValues<S>& names, std::vector<Closure<S>>& closures) {
  Closure<S> closure;
  closure.constraint = place;
  if (spec.coincident) {
    Station<S> from = calcStation(spec.coincident->from, system, names);
    Station<S> to = calcStation(spec.coincident->to, system, names);
    const std::size_t first = closures.size();
    const bool swapped = from.body == 0;
    if (swapped) {
      std::swap(from, to);
    }
    addCoincidence(from, to, makeDiagonal(S(1.0)), place, closures);
    for (std::size_t i = first; i < closures.size(); ++i) {
      closures[i].swapped = swapped;
    }
  } else if (spec.rod) {
    closure.kind = ClosureKind::kRod;
    closure.from = calcStation(spec.rod->from, system, names);
    closure.to = calcStation(spec.rod->to, system, names);
    closure.length = names.calc(spec.rod->length);
    closures.push_back(closure);
  } else if (spec.point_in_plane) {
    const PlaneSpec& plane = spec.point_in_plane->plane;
    closure.kind = ClosureKind::kPlane;
    closure.from = {system.findBody(plane.body), names.calc3(plane.point)};
    closure.to = calcStation(spec.point_in_plane->station, system, names);
    closure.normal = normalize(names.calc3(plane.normal));
    closures.push_back(closure);
  } else if (spec.gear) {
    addGear(*spec.gear, system, names, closure, closures);
  } else if (spec.rolling) {
    addRolling(*spec.rolling, system, names, closure, closures);
  } else if (spec.weld) {
    addFrames(spec.weld->from, spec.weld->to, true, system, names, closure, closures);
  } else {
    addFrames(spec.pin->from, spec.pin->to, false, system, names, closure, closures);
  }
}

/// Numbers without checks: those of a recorded program are symbols.
template <class S>
struct UncheckedNumbers {
  const NamedValues<S>& names;
  S calc(const Expression& expression, const std::string&, const char*, const char*) const {
    return names.calc(expression);
  }
  bool knows(const Expression& expression) const { return usesOnly(names, expression); }
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
  for (std::size_t i = 0; i < spec.constraints.size(); ++i) {
    addClosures(spec.constraints[i], static_cast<int>(i), system, names, values.closures);
  }
  for (const ArmatureSpec& one : spec.armature) {
    values.armature.emplace_back(system.findForcedCoordinate(one.coordinate), names.calc(one.inertia));
  }
  values.state_count = static_cast<int>(system.getStateNames().size());
  return values;
}

}  // namespace twinmap::equations
