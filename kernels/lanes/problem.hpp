#pragma once

#include <vector>

#include "kernels/lanes/program/program.hpp"
#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::lanes {

/// A value that has the derivatives of another.
struct Passed {
  program::Symbol value, as;
};

/// Differential equations y' = f(t, y; p, u) with parameters p and phase inputs u, and what is wanted of
/// their solution, as recorded symbols. Only the counts' states, parameters and phase inputs may be used.
/// An output with a delay is that of the time before, and of the first phase's begin where that is earlier;
/// it must begin at 0 then.
struct Equations {
  program::InputCounts counts;
  std::vector<program::Symbol> derivatives;  ///< one a state
  std::vector<program::Symbol> pivots;       ///< must stay positive wherever f is evaluated
  std::vector<program::Symbol> outputs;      ///< of t, y, p and u
  std::vector<program::Symbol> delays{};     ///< s; of p alone
  std::vector<int> output_delays{};          ///< of each output its delay, -1: none; empty: none has any
  std::vector<program::Symbol> jumps{};      ///< y behind the begin of a phase that jumps, of t, y, p and u
  /// Values within the jumps that change as others do, which come before them: what a quantiser makes of
  /// them.
  std::vector<Passed> passed{};
  /// Events whose time depends on the solution: guard k is positive, and where it no longer is the states
  /// become `transitions`, at which the phase input `event_input` is 1 + k; at the start, before all else, it
  /// is 0. At most one event at a time; those that it causes follow at the same time.
  std::vector<program::Symbol> guards{}, transitions{};
  int event_input = -1;  ///< 0 in all phases
  /// Where solutions satisfy conditions that steps leave by their error: the states near y that satisfy them,
  /// one a state. Empty: there are none.
  std::vector<program::Symbol> projection{};
  /// Of each guard a smooth function that is not positive only where the guard may not be either: what moves
  /// by a polynomial takes steps so long that a guard could fall below 0 and return between two looks. Empty:
  /// none is looked for.
  std::vector<program::Symbol> dips{};
};

/// What is integrated: the states and, behind them, their derivatives with respect to each direction (a
/// parameter), direction by direction: s' = (df/dy) s + df/dp.
struct Problem {
  program::InputCounts counts;  ///< of the equations alone
  std::vector<int> directions;  ///< parameters
  int pivot_count = 0;
  int output_count = 0;
  program::Program derivative;       ///< derivatives of all rows, then pivots
  program::Program output;           ///< outputs, then their derivatives, direction by direction
  std::vector<int> output_delays{};  ///< as Equations has them
  int delay_count = 0;
  /// All rows behind a jump; behind the phase inputs it reads by how much its time moves with each direction.
  /// Without outputs: none.
  program::Program jump{};
  program::Program projection{};  ///< of all rows; without outputs where there is none
  int guard_count = 0, dip_count = 0, event_input = -1;
  program::Program guard{};         ///< guards, then dips, of the states alone
  program::Program guard_change{};  ///< their rates along the solution, then their changes by direction
  program::Program transition{};    ///< all rows behind an event; inputs as those of `jump`

  int getRowCount() const { return counts.states * (1 + static_cast<int>(directions.size())); }
};

/// Compiles the equations, extended by the sensitivities for `directions` (indices of parameters; none:
/// values alone). Phase inputs must not depend on those parameters. Appends to the recorder.
Problem makeProblem(program::Recorder& recorder, const Equations& equations,
                    const std::vector<int>& directions = {});

}  // namespace twinmap::lanes
