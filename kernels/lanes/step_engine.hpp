#pragma once

#include "kernels/program/engine.hpp"

namespace twinmap::lanes {

/// Arrays of one step of all lanes. Rows of `lanes` doubles, at multiples of 32 bytes.
struct StepArrays {
  int rows, pivots;
  const double* const* derivatives;   ///< where the program leaves each row's derivative
  const double* const* pivot_values;  ///< and each pivot
  double* stage_state;                ///< rows; what the program is evaluated at
  double* stage_time;
  double* state;      ///< rows; at the begin of the step
  double* slopes[8];  ///< rows each; [1] to [7], k in Dormand and Prince's pair
  double* time;
  double* step;                      ///< s
  double* smallest_pivot;            ///< over the stages of the step
  const double* absolute_tolerance;  ///< one number a row
  const double* relative_tolerance;  ///< one number a row
  double* error;   ///< largest of all rows, in tolerances; NaN where something is not finite
  double* factor;  ///< 0.85 error^(-1/5): by what the controller wants to change the step
};

/// Arithmetic of Dormand and Prince's 5(4) pair on all lanes at a time, for one number of lanes.
struct StepEngine {
  const program::Engine& program;
  /// The state and time at which stage 2 ... 7 is to be evaluated, from the derivatives that stage - 1 left.
  void (*prepareStage)(int stage, const StepArrays& arrays);
  /// After stage 7: its slopes, the error and the factor. The new state is the last stage's.
  void (*finish)(const StepArrays& arrays);
  /// Takes the new state and slopes in lanes where `accepted` is not 0.
  void (*accept)(const double* accepted, const StepArrays& arrays);
  /// The solution at fractions 0 ... 1 of the finished step, before accept(): `states` in rows.
  void (*interpolate)(const double* fractions, const StepArrays& arrays, double* states);
};

extern const StepEngine kSteps4, kSteps8, kSteps8Of4, kSteps16;

}  // namespace twinmap::lanes
