#include "framework/models/mechanism/simbody/constraints.hpp"

#include "framework/models/mechanism/constraint_numbers.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::Constraint;
using SimTK::MobilizedBody;
using SimTK::MobilizedBodyIndex;

/// coordinate - ratio * driver - offset = 0
SimTK::ConstraintIndex addGear(SimTK::SimbodyMatterSubsystem& matter, const ConstraintNumbers& gear,
                               const SystemNames& names) {
  SimTK::Vector coefficients(3);
  coefficients[0] = 1.0;
  coefficients[1] = -gear.ratio;
  coefficients[2] = -gear.offset;
  SimTK::Array_<MobilizedBodyIndex> bodies;
  SimTK::Array_<SimTK::MobilizerQIndex> coordinates;
  for (const int index : {gear.coordinate, gear.driver}) {
    const CoordinatePlace& place = names.getCoordinates()[index];
    bodies.push_back(MobilizedBodyIndex(place.body));
    coordinates.push_back(SimTK::MobilizerQIndex(place.local));
  }
  return Constraint::CoordinateCoupler(matter, new SimTK::Function::Linear(coefficients), bodies,
                                       coordinates);
}

/// Origins that coincide, and directions at right angles: both axes of `from` across the hinge to it.
std::vector<SimTK::ConstraintIndex> addPin(MobilizedBody& from, const SimTK::Transform& from_frame,
                                           MobilizedBody& to, const SimTK::Transform& to_frame) {
  std::vector<SimTK::ConstraintIndex> added{Constraint::Ball(from, from_frame.p(), to, to_frame.p())};
  for (const SimTK::UnitVec3& across : {from_frame.x(), from_frame.y()}) {
    added.push_back(Constraint::ConstantAngle(from, across, to, to_frame.z()));
  }
  return added;
}

std::vector<SimTK::ConstraintIndex> addBetweenBodies(MobilizedBody& from, MobilizedBody& to,
                                                     const ConstraintSpec& spec,
                                                     const ConstraintNumbers& one) {
  const SimTK::Vec3 from_point = toVec3(one.from.point), to_point = toVec3(one.to.point);
  if (spec.coincident) {
    return {Constraint::Ball(from, from_point, to, to_point)};
  }
  if (spec.rod) {
    return {Constraint::Rod(from, from_point, to, to_point, one.length)};
  }
  if (spec.weld) {
    return {Constraint::Weld(from, toTransform(one.from_frame), to, toTransform(one.to_frame))};
  }
  if (spec.pin) {
    return addPin(from, toTransform(one.from_frame), to, toTransform(one.to_frame));
  }
  const SimTK::UnitVec3 normal(toVec3(one.normal));
  if (spec.rolling) {
    const SimTK::Transform plane(SimTK::Rotation(normal, SimTK::ZAxis), from_point);
    return {Constraint::SphereOnPlaneContact(from, plane, to, to_point, one.length, true)};
  }
  return {Constraint::PointInPlane(from, normal, SimTK::dot(normal, from_point), to, to_point)};
}

}  // namespace

std::vector<std::vector<SimTK::ConstraintIndex>> addConstraints(SimTK::SimbodyMatterSubsystem& matter,
                                                                const SystemSpec& spec,
                                                                const SystemNames& names,
                                                                ModelNumbers& numbers) {
  const std::vector<ConstraintNumbers> all = calcConstraintNumbers(spec, names, numbers);
  std::vector<std::vector<SimTK::ConstraintIndex>> added;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ConstraintNumbers& one = all[i];
    if (spec.constraints[i].gear) {
      added.push_back({addGear(matter, one, names)});
    } else {
      added.push_back(addBetweenBodies(matter.updMobilizedBody(MobilizedBodyIndex(one.from.body)),
                                       matter.updMobilizedBody(MobilizedBodyIndex(one.to.body)),
                                       spec.constraints[i], one));
    }
  }
  return added;
}

}  // namespace twinmap
