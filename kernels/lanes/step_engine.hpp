#pragma once

#include "kernels/lanes/program/engine.hpp"

namespace twinmap::lanes {

/// Arrays of one step of all lanes. Rows of `lanes` doubles, at multiples of 32 bytes; times in s.
struct StepArrays {
  int rows, pivots;
  const double* const* derivatives;   ///< where the program leaves each row's derivative
  const double* const* pivot_values;  ///< and each pivot
  double* stage_state;                ///< rows; what the program is evaluated at
  double* stage_time;
  double* state;      ///< rows; at the begin of the step
  double* slopes[8];  ///< rows each; [1] to [7], k in Dormand and Prince's pair
  double*
      interpolated;  ///< rows of StepEngine::times, or of all lanes; the solution within the finished step
  double* wanted;    ///< as many times of that step
  const double* absolute_tolerance;  ///< one number a row
  const double* relative_tolerance;  ///< one number a row
  // of the step in work
  double* fraction;        ///< 0 ... 1 of it, where all lanes are interpolated
  double* time;            ///< its begin
  double* step;            ///< its size
  double* end;             ///< its end; exactly the phase's for the last of a phase
  double* smallest_pivot;  ///< over its stages
  double* error;           ///< largest of all rows, in tolerances; NaN where something is not finite
  double* accepted;        ///< 1 or 0
  // of the controller
  double* proposed;  ///< size of the next step; 0: one that leaves the state
  double* growth;    ///< by how much a step may be larger than the one before
  double* phase_end;
  double* next_output;  ///< first output time not yet kept, or infinity
  double* steps;        ///< tried in the sample; those of size 0 do not count
  double* next_check;   ///< number of steps at which to look at limits
};

/// A step of this part of the time, or of kSmallestTime (s), is too small: eight units in the last place.
constexpr double kSmallestStep = 0x1p-49, kSmallestTime = 1e-9;
constexpr double kLargestGrowth = 10.0;  // of a step over the one before

/// Arithmetic of Dormand and Prince's 5(4) pair on all lanes at a time, for one number of lanes.
struct StepEngine {
  const program::Engine& program;
  int times;  ///< that are interpolated together
  /// Chooses each lane's step: as proposed, but half of the way to the phase's end at most, or all of it.
  void (*plan)(const StepArrays& arrays);
  /// The state and time at which stage 2 ... 7 is to be evaluated, from the derivatives that stage - 1 left.
  void (*prepareStage)(int stage, const StepArrays& arrays);
  /// After stage 7: error, whether the step is accepted, and the size of the next one. The new state is the
  /// last stage's. Returns the lanes (bit by bit) with more to do than to go on: where a step was rejected,
  /// had size 0, ends its phase, passes an output time, met a pivot that is not positive, or is to be checked
  /// against limits.
  unsigned (*finish)(const StepArrays& arrays);
  /// The states of one lane at each of the times `wanted`, before accept().
  void (*interpolate)(int lane, const StepArrays& arrays);
  /// The state of each lane at its `fraction` of the step, before accept().
  void (*interpolateAll)(const StepArrays& arrays);
  /// Takes the new time, state and slopes in lanes where `accepted` is not 0.
  void (*accept)(const StepArrays& arrays);
};

extern const StepEngine kSteps4, kSteps8, kSteps8Of4, kSteps16, kSteps16Of4;

}  // namespace twinmap::lanes
