#pragma once

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/interpreter.hpp"
#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// What a problem's events need, of all lanes: guards, how they change, and the states behind them.
class EventPrograms {
 public:
  EventPrograms(const Problem& problem, const program::Engine& engine);

  void setSample(int lane, const Sample& sample);
  void setPhase(int lane, const Phase& phase);

  /// At each lane's time and states; row r of lane l is states[r * lanes + l].
  void calcGuards(const double* times, const double* states);
  int getCount() const { return count_; }
  double getGuard(int guard, int lane) const { return guards_.getOutput(guard)[lane]; }
  int getDipCount() const { return dip_count_; }
  double getDip(int dip, int lane) const { return guards_.getOutput(count_ + dip)[lane]; }
  /// The smallest of all guards; positive while no event is due.
  double calcSmallest(int lane) const;

  /// At times and all rows: getRate() d guard / dt along the solution, getChange() d guard / d parameter.
  void calcChanges(const double* times, const double* rows);
  double getRate(int guard, int lane) const { return changes_.getOutput(guard)[lane]; }
  double getChange(int guard, int direction, int lane) const {
    return changes_.getOutput((1 + direction) * count_ + guard)[lane];
  }

  /// To be filled like that of jumps.
  program::Interpreter& updTransitions() { return transitions_; }
  int getEventInput() const { return event_input_; }

 private:
  const int count_, dip_count_, states_, rows_, event_input_;
  program::Interpreter guards_, changes_, transitions_;
  bool guards_stale_ = true, changes_stale_ = true;  ///< parameters or phase inputs have changed
};

}  // namespace twinmap::lanes
