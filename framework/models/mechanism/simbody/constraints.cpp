#include "framework/models/mechanism/simbody/constraints.hpp"

#include "framework/models/mechanism/constraint_numbers.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {
namespace {

using SimTK::Constraint;
using SimTK::MobilizedBody;
using SimTK::MobilizedBodyIndex;

/// coordinate - ratio * driver - offset = 0
void addGear(SimTK::SimbodyMatterSubsystem& matter, const ConstraintNumbers& gear, const SystemNames& names) {
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
  Constraint::CoordinateCoupler(matter, new SimTK::Function::Linear(coefficients), bodies, coordinates);
}

}  // namespace

void addConstraints(SimTK::SimbodyMatterSubsystem& matter, const SystemSpec& spec, const SystemNames& names,
                    ModelNumbers& numbers) {
  const std::vector<ConstraintNumbers> all = calcConstraintNumbers(spec, names, numbers);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ConstraintNumbers& one = all[i];
    if (spec.constraints[i].gear) {
      addGear(matter, one, names);
      continue;
    }
    MobilizedBody &from = matter.updMobilizedBody(MobilizedBodyIndex(one.from.body)),
                  &to = matter.updMobilizedBody(MobilizedBodyIndex(one.to.body));
    const SimTK::Vec3 from_point = toVec3(one.from.point), to_point = toVec3(one.to.point);
    if (spec.constraints[i].coincident) {
      Constraint::Ball(from, from_point, to, to_point);
    } else if (spec.constraints[i].rod) {
      Constraint::Rod(from, from_point, to, to_point, one.length);
    } else {
      const SimTK::UnitVec3 normal(toVec3(one.normal));
      Constraint::PointInPlane(from, normal, SimTK::dot(normal, from_point), to, to_point);
    }
  }
}

}  // namespace twinmap
