#pragma once

#include <vector>

#include "kernels/lanes/program/program.hpp"
#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::lanes {

/// Differential equations y' = f(t, y; p, u) with parameters p and phase inputs u, and what is wanted of
/// their solution, as recorded symbols. Only the counts' states, parameters and phase inputs may be used.
struct Equations {
  program::InputCounts counts;
  std::vector<program::Symbol> derivatives;  ///< one a state
  std::vector<program::Symbol> pivots;       ///< must stay positive wherever f is evaluated
  std::vector<program::Symbol> outputs;      ///< of t, y, p and u
  /// Where solutions satisfy conditions that steps leave by their error: the states near y that satisfy them,
  /// one a state. Empty: there are none.
  std::vector<program::Symbol> projection{};
};

/// What is integrated: the states and, behind them, their derivatives with respect to each direction (a
/// parameter), direction by direction: s' = (df/dy) s + df/dp.
struct Problem {
  program::InputCounts counts;  ///< of the equations alone
  std::vector<int> directions;  ///< parameters
  int pivot_count = 0;
  int output_count = 0;
  program::Program derivative;  ///< derivatives of all rows, then pivots
  program::Program output;      ///< outputs, then their derivatives, direction by direction
  program::Program projection;  ///< of all rows; without outputs where there is none

  int getRowCount() const { return counts.states * (1 + static_cast<int>(directions.size())); }
};

/// Compiles the equations, extended by the sensitivities for `directions` (indices of parameters; none:
/// values alone). Phase inputs must not depend on those parameters. Appends to the recorder.
Problem makeProblem(program::Recorder& recorder, const Equations& equations,
                    const std::vector<int>& directions = {});

}  // namespace twinmap::lanes
