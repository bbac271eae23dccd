#pragma once

#include <Simbody.h>

#include <array>
#include <vector>

#include "framework/models/mechanism/simbody/body_tree.hpp"
#include "framework/models/mechanism/simbody/tree_dynamics.hpp"

namespace twinmap {

/// A point fixed to a body, in its frame.
struct Station {
  int body;
  SimTK::Vec3 point;
};

/// Sums forces on bodies (at their origins, in the ground frame) and on speeds.
class ForceSum {
 public:
  ForceSum(const BodyTree& tree, const SimTK::State& state, SystemForces& forces)
      : tree_(tree), state_(state), forces_(forces) {}

  /// Forces and moments in the ground frame.
  void addForce(const Station& station, const SimTK::Vec3& force);
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

struct CoordinateSpring {
  int coordinate;
  double stiffness, rest;
};
struct CoordinateDamper {
  int coordinate;
  double damping;
};
struct TwoPointSpring {
  Station from, to;
  double stiffness, rest_length;
};
struct TwoPointDamper {
  Station from, to;
  double damping;
};
struct FramedBody {
  int body;
  SimTK::Transform frame;
};
struct Bushing {
  FramedBody from, to;
  std::array<double, 6> stiffness, damping;
};

/// The forces of one parameter set that depend on the state only: gravity, springs, dampers, bushings.
struct PassiveForces {
  SimTK::Vec3 gravity{0.0};
  std::vector<CoordinateSpring> springs;
  std::vector<CoordinateDamper> dampers;
  std::vector<TwoPointSpring> two_point_springs;
  std::vector<TwoPointDamper> two_point_dampers;
  std::vector<Bushing> bushings;
};

Station calcStation(const StationSpec& spec, const SystemNames& names, NumberEvaluator& numbers,
                    const std::string& owner);

/// Throws SimulationFailure for numbers that are not finite, ExperimentError for unknown names and for a
/// spring or damper on a coordinate that takes no forces.
PassiveForces calcPassiveForces(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers);

/// Adds all passive forces at a state that is realized to Velocity. No memory is allocated.
void addPassiveForces(const PassiveForces& forces, ForceSum& sum);

/// Adds -(stiffness * q + damping * q') along the six relative coordinates q of two frames (body-fixed x-y-z
/// angles and translations of `to` in `from`), as Simbody's Force::LinearBushing does.
void addBushing(const Bushing& bushing, ForceSum& sum);

}  // namespace twinmap
