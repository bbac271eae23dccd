#pragma once

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/interpreter.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// Moves states back to the conditions that solutions satisfy, with their sensitivities, which follow by the
/// chain rule.
class StateProjection {
 public:
  StateProjection(const Problem& problem, const program::Engine& engine);

  void setSample(int lane, const Sample& sample);
  void setPhase(int lane, const Phase& phase);
  /// `states`: row r of lane l is states[r * lanes + l]; changed in lanes where `taken` is not 0, at each
  /// lane's time.
  void apply(const double* times, const double* taken, double* states);

 private:
  const int rows_, lanes_;
  program::Interpreter interpreter_;
  bool changed_ = true;  ///< parameters or phase inputs
};

}  // namespace twinmap::lanes
