#pragma once

#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

enum class Integrator { kDopri5, kRungeKuttaMerson, kCpodes };

template <>
struct EnumNames<Integrator> {
  static constexpr EnumName<Integrator> values[] = {
      {"dopri5", Integrator::kDopri5},
      {"runge_kutta_merson", Integrator::kRungeKuttaMerson},
      {"cpodes", Integrator::kCpodes},
  };
};

/// What evaluates the equations of motion; kAutomatic: lanes where they can.
enum class Engine { kAutomatic, kLanes, kSimbody };

template <>
struct EnumNames<Engine> {
  static constexpr EnumName<Engine> values[] = {
      {"automatic", Engine::kAutomatic},
      {"lanes", Engine::kLanes},
      {"simbody", Engine::kSimbody},
  };
};

struct SimulationSpec {
  double duration = 0.0;  ///< s; above 0 where features are made of outputs
  Engine engine = Engine::kAutomatic;
  Integrator integrator = Integrator::kDopri5;
  double relative_tolerance = 3e-7;  ///< local error per step, relative to the state
  double absolute_tolerance = 1e-9;  ///< and absolute, in the state's own units
  int max_steps = 100000;            ///< per sample; more is reported as a failure
  bool portable = false;             ///< the same bits on all processors of the common set, x86-64-v3
  double max_wall_time = 60.0;       ///< s per sample; more is reported as a failure
  double allowed_failures = 0.05;    ///< fraction of a set's samples that may fail before the run does
};

template <class Fields>
void describe(Fields& f, SimulationSpec& s) {
  constexpr NumberRule kRelative{1e-13, 0.1, true, "must be a number from 1e-13 to 0.1"};
  constexpr NumberRule kAbsolute{1e-18, 1.0, true, "must be a number from 1e-18 to 1"};
  constexpr NumberRule kWallTime{0.0, 86400.0, false, "must be a number above 0, at most 86400 (a day)"};
  f.optional("duration", s.duration, "simulated time; s; needed for features of outputs", kNonNegative);
  f.optional("engine", s.engine,
             "several samples at a time in lanes, or Simbody; automatic: lanes if they can");
  f.optional("integrator", s.integrator, "dopri5, or one of Simbody's as a cross-check");
  f.optional("relative_tolerance", s.relative_tolerance, "local error per step, relative", kRelative);
  f.optional("absolute_tolerance", s.absolute_tolerance, "local error per step, absolute", kAbsolute);
  f.optional("max_steps", s.max_steps, "per sample; more is a failure", kCount);
  f.optional("portable", s.portable,
             "the same bits on all processors (x86-64-v3): lanes, or the portable build");
  f.optional("max_wall_time", s.max_wall_time, "per sample; more is a failure; s", kWallTime);
  f.optional("allowed_failures", s.allowed_failures,
             "fraction of the training or test samples that may fail before the run does", kFraction);
}

}  // namespace twinmap
