#pragma once

#include <Simbody.h>

#include "framework/models/mechanism/force_numbers.hpp"
#include "framework/models/mechanism/simbody/body_tree.hpp"
#include "framework/models/mechanism/simbody/tree_dynamics.hpp"

namespace twinmap {

/// Sums forces on bodies (at their origins, in the ground frame) and on speeds.
class ForceSum {
 public:
  ForceSum(const BodyTree& tree, const SimTK::State& state, SystemForces& forces)
      : tree_(tree), state_(state), forces_(forces) {}

  /// Forces and moments in the ground frame.
  void addForce(int body, const SimTK::Vec3& point,
                const SimTK::Vec3& force);                                 ///< point: in the body's frame
  void addAt(int body, const SimTK::Vec3& arm, const SimTK::Vec3& force);  ///< arm: from the origin
  void addMoment(int body, const SimTK::Vec3& moment) { forces_.on_bodies[body][0] += moment; }
  void addOnCoordinate(int coordinate, double force) {
    forces_.on_speeds[tree_.getSlots()[coordinate].u] += force;
  }

  const BodyTree& getTree() const { return tree_; }
  const SimTK::State& getState() const { return state_; }
  const SimTK::MobilizedBody& getBody(int index) const { return tree_.getBody(index); }

 private:
  const BodyTree& tree_;
  const SimTK::State& state_;
  SystemForces& forces_;
};

/// Adds all passive forces at a state that is realized to Velocity. No memory is allocated.
void addPassiveForces(const PassiveForces& forces, ForceSum& sum);

/// Adds -(stiffness * q + damping * q') along the six relative coordinates q of two frames (body-fixed x-y-z
/// angles and translations of `to` in `from`), as Simbody's Force::LinearBushing does.
void addBushing(const Bushing& bushing, ForceSum& sum);

}  // namespace twinmap
