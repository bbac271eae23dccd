#include "framework/models/mechanism/simbody/body_tree.hpp"

#include "framework/models/mechanism/simbody/constraints.hpp"
#include "framework/models/mechanism/simbody/joints.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"

namespace twinmap {

BodyTree::BodyTree(const SystemSpec& spec, const SystemNames& names, ModelNumbers& numbers) : names_(names) {
  matter_.setShowDefaultGeometry(false);
  for (const BodySpec& body : spec.bodies) {
    const SimTK::Body::Rigid rigid(toMassProperties(calcMassNumbers(body, numbers)));
    const SimTK::MobilizedBodyIndex parent(names.findBody(body.joint.parent));
    addMobilizer(matter_.updMobilizedBody(parent), rigid, body, numbers);
  }
  constraints_ = addConstraints(matter_, spec, names, numbers);
}

void BodyTree::realize() {
  state_ = system_.realizeTopology();
  matter_.setUseEulerAngles(state_, true);
  system_.realizeModel(state_);
  system_.realize(state_, SimTK::Stage::Time);
  for (const CoordinatePlace& place : names_.getCoordinates()) {
    const SimTK::MobilizedBody& body = getBody(place.body);
    slots_.push_back({static_cast<int>(body.getFirstQIndex(state_)) + place.local,
                      static_cast<int>(body.getFirstUIndex(state_)) + place.local});
  }
}

void BodyTree::realizeVelocity(const SimTK::State& state) const {
  const SimTK::Subsystem::Guts& matter = matter_.getSubsystemGuts();
  matter.realizeSubsystemPosition(state);
  matter.realizeSubsystemVelocity(state);
}

}  // namespace twinmap
