#include "kernels/lanes/event_programs.hpp"

#include <algorithm>
#include <limits>

namespace twinmap::lanes {
namespace {

void calcAt(program::Interpreter& program, bool& stale, const double* times, const double* states,
            int count) {
  if (stale) {
    program.calcParameters();
    program.calcPhase();
    stale = false;
  }
  const int lanes = program.getLanes();
  std::copy_n(times, lanes, program.updTime());
  std::copy_n(states, count * lanes, program.updState(0));
  program.calcOutputs();
}

}  // namespace

EventPrograms::EventPrograms(const Problem& problem, const program::Engine& engine)
    : count_(problem.guard_count),
      dip_count_(problem.dip_count),
      states_(problem.counts.states),
      rows_(problem.getRowCount()),
      event_input_(problem.event_input),
      guards_(problem.guard, engine),
      changes_(problem.guard_change, engine),
      transitions_(problem.transition, engine) {}

void EventPrograms::setSample(int lane, const Sample& sample) {
  for (std::size_t i = 0; i < sample.parameters.size(); ++i) {
    guards_.updParameter(static_cast<int>(i))[lane] = sample.parameters[i];
    changes_.updParameter(static_cast<int>(i))[lane] = sample.parameters[i];
  }
  guards_stale_ = changes_stale_ = true;
}

void EventPrograms::setPhase(int lane, const Phase& phase) {
  for (std::size_t i = 0; i < phase.inputs.size(); ++i) {
    guards_.updPhaseInput(static_cast<int>(i))[lane] = phase.inputs[i];
    changes_.updPhaseInput(static_cast<int>(i))[lane] = phase.inputs[i];
  }
  guards_stale_ = changes_stale_ = true;
}

void EventPrograms::calcGuards(const double* times, const double* states) {
  calcAt(guards_, guards_stale_, times, states, states_);
}

double EventPrograms::calcSmallest(int lane) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < count_; ++k) {
    smallest = std::min(smallest, getGuard(k, lane));
  }
  return smallest;
}

void EventPrograms::calcChanges(const double* times, const double* rows) {
  calcAt(changes_, changes_stale_, times, rows, rows_);
}

}  // namespace twinmap::lanes
