#pragma once

#include "framework/base/text/source_location.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

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

/// A tolerance of the integration, or one that follows the noise. Converts from and to a plain number, which
/// is all that simulators want.
struct Tolerance {
  Tolerance(double given) : value(given) {}  // NOLINT(google-explicit-constructor)
  static Tolerance makeAutomatic(double loosest) {
    Tolerance tolerance(loosest);
    tolerance.automatic = true;
    return tolerance;
  }
  operator double() const { return value; }  // NOLINT(google-explicit-constructor)

  double value;  ///< where it is automatic: the loosest that may be taken
  bool automatic = false;
  SourceLocation where{};  ///< in its file, where it is given there
};

struct SimulationSpec {
  double duration = 0.0;  ///< s; above 0 where features are made of outputs
  Engine engine = Engine::kAutomatic;
  /// Local error per step, relative to the state, and absolute, in the state's own units.
  Tolerance relative_tolerance = Tolerance::makeAutomatic(3e-7);
  Tolerance absolute_tolerance = Tolerance::makeAutomatic(1e-9);
  int max_steps = 100000;          ///< per sample; more is reported as a failure
  bool portable = false;           ///< the same bits on all processors of the common set, x86-64-v3
  double max_wall_time = 60.0;     ///< s per sample; more is reported as a failure
  double allowed_failures = 0.05;  ///< fraction of a set's samples that may fail before the run does
};

template <class Fields>
void describe(Fields& f, SimulationSpec& s) {
  constexpr NumberRule kRelative{1e-13, 0.1, true, "must be automatic or a number from 1e-13 to 0.1"};
  constexpr NumberRule kAbsolute{1e-18, 1.0, true, "must be automatic or a number from 1e-18 to 1"};
  constexpr NumberRule kWallTime{0.0, 86400.0, false, "must be a number above 0, at most 86400 (a day)"};
  f.optional("duration", s.duration, "simulated time; s; needed for features of outputs", kNonNegative);
  f.optional("engine", s.engine,
             "several samples at a time in lanes, or Simbody; automatic: lanes if they can");
  f.optional("relative_tolerance", s.relative_tolerance,
             "local error per step, relative; automatic: as the noise asks for", kRelative);
  f.optional("absolute_tolerance", s.absolute_tolerance,
             "local error per step, absolute; automatic: as the noise asks for", kAbsolute);
  f.optional("max_steps", s.max_steps, "per sample; more is a failure", kCount);
  f.optional("portable", s.portable,
             "the same bits on all processors (x86-64-v3): lanes, or the portable build");
  f.optional("max_wall_time", s.max_wall_time, "per sample; more is a failure; s", kWallTime);
  f.optional("allowed_failures", s.allowed_failures,
             "fraction of the training or test samples that may fail before the run does", kFraction);
}

}  // namespace twinmap
