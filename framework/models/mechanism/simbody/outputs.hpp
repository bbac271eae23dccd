#pragma once

#include <vector>

#include "framework/models/mechanism/simbody/loaded_system.hpp"
#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {

/// The outputs of one parameter set.
class Outputs {
 public:
  /// Throws SimulationFailure for a direction of no length, and a gain or offset that is not finite.
  Outputs(const std::vector<OutputSpec>& outputs, const SystemNames& names, ModelNumbers& numbers);

  /// How far a state must be realized before calc(): Time if only coordinates are measured.
  SimTK::Stage getNeededStage() const { return stage_; }

  /// Writes output o at time t to values[o * stride]. `state`: realized to getNeededStage().
  void calc(LoadedSystem& system, const SimTK::State& state, double t, double* values,
            std::ptrdiff_t stride) const;

 private:
  double calcQuantity(const OutputNumbers& output, const LoadedSystem& system,
                      const SimTK::State& state) const;
  double calcAcceleration(const OutputNumbers& output, const LoadedSystem& system, const SimTK::State& state,
                          const SimTK::Vector_<SimTK::SpatialVec>& accelerations) const;

  static double calcReaction(const OutputNumbers& output, const LoadedSystem& system,
                             const SimTK::State& state);
  static double calcForce(const OutputNumbers& output, LoadedSystem& system, const SimTK::State& state);
  static equations::Exerted<double> calcConstraintForce(const NamedForce& force, const LoadedSystem& system,
                                                        const SimTK::State& state);

  std::vector<OutputNumbers> outputs_;
  SimTK::Stage stage_ = SimTK::Stage::Time;
  bool needs_accelerations_ = false, has_expressions_ = false;
};

}  // namespace twinmap
