#pragma once

#include <Simbody.h>

#include <optional>
#include <vector>

#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Simbody's system of one parameter set: its bodies, joints and constraints, with Euler angles for all
/// orientations. Built anew for every sample, which costs 1 % of its simulation.
class BodyTree {
 public:
  /// Where Simbody keeps a coordinate and its speed.
  struct Slot {
    int q, u;
  };

  /// Throws SimulationFailure for numbers that no real system has.
  BodyTree(const SystemSpec& spec, const SystemNames& names, ModelNumbers& numbers);

  /// Where forces are put that Simbody's own integrators are to see; call once, before realize().
  SimTK::GeneralForceSubsystem& addForceSubsystem() { return forces_.emplace(system_); }

  /// Completes the system; the state is then ready to take coordinates.
  void realize();

  /// Computes positions and velocities of the bodies. Goes to the only subsystem concerned: Simbody's walk
  /// over all of them costs another fifth of an evaluation of the accelerations.
  void realizeVelocity(const SimTK::State& state) const;

  bool hasConstraints() const { return matter_.getNumConstraints() > 0; }
  const SimTK::MultibodySystem& getSystem() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& getMatter() const { return matter_; }
  const SimTK::MobilizedBody& getBody(int index) const {
    return matter_.getMobilizedBody(SimTK::MobilizedBodyIndex(index));
  }
  const std::vector<Slot>& getSlots() const { return slots_; }  ///< one per coordinate
  /// Those of each of the file's constraints.
  const std::vector<std::vector<SimTK::ConstraintIndex>>& getConstraints() const { return constraints_; }
  const SimTK::State& getDefaultState() const { return state_; }

 private:
  const SystemNames& names_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  std::optional<SimTK::GeneralForceSubsystem> forces_;
  SimTK::State state_;
  std::vector<Slot> slots_;
  std::vector<std::vector<SimTK::ConstraintIndex>> constraints_;
};

}  // namespace twinmap
