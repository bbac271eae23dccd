#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {

/// Units of all outputs: m, rad, m/s, rad/s or m/s2. Throws ExperimentError for unknown coordinates or bodies
/// and for an output that measures nothing or several things.
std::vector<std::string> getOutputUnits(const std::vector<OutputSpec>& outputs, const SystemNames& names);

/// The outputs of one parameter set.
class Outputs {
 public:
  /// Throws SimulationFailure for a direction of no length, and a gain or offset that is not finite.
  Outputs(const std::vector<OutputSpec>& outputs, const SystemNames& names, NumberEvaluator& numbers);

  /// How far a state must be realized before calc(): Time if only coordinates are measured.
  SimTK::Stage getNeededStage() const { return stage_; }

  /// Writes output o at time t to values[o * stride]. `state`: realized to getNeededStage().
  void calc(LoadedSystem& system, const SimTK::State& state, double t, double* values,
            std::ptrdiff_t stride) const;

 private:
  enum class Kind { kCoordinate, kSpeed, kPosition, kVelocity, kAcceleration };
  struct Sensor {
    double gain, offset;  ///< the offset in the output's unit
  };
  struct Output {
    Kind kind;
    int coordinate;
    Station station;
    SimTK::Vec3 direction;
    std::optional<Sensor> sensor;
  };

  static Output makeQuantity(const OutputSpec& spec, const SystemNames& names, NumberEvaluator& numbers);
  static Output makeOutput(const OutputSpec& spec, const SystemNames& names, NumberEvaluator& numbers);
  double calcQuantity(const Output& output, const LoadedSystem& system, const SimTK::State& state) const;
  double calcAcceleration(const Output& output, const LoadedSystem& system, const SimTK::State& state,
                          const SimTK::Vector_<SimTK::SpatialVec>& accelerations) const;

  std::vector<Output> outputs_;
  SimTK::Stage stage_ = SimTK::Stage::Time;
  bool needs_accelerations_ = false;
};

}  // namespace twinmap
