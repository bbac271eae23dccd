#include "kernels/lanes/state_projection.hpp"

#include <algorithm>

namespace twinmap::lanes {

StateProjection::StateProjection(const Problem& problem, const program::Engine& engine)
    : rows_(problem.getRowCount()), lanes_(engine.lanes), interpreter_(problem.projection, engine) {}

void StateProjection::setSample(int lane, const Sample& sample) {
  for (std::size_t i = 0; i < sample.parameters.size(); ++i) {
    interpreter_.updParameter(static_cast<int>(i))[lane] = sample.parameters[i];
  }
  changed_ = true;
}

void StateProjection::setPhase(int lane, const Phase& phase) {
  for (std::size_t i = 0; i < phase.inputs.size(); ++i) {
    interpreter_.updPhaseInput(static_cast<int>(i))[lane] = phase.inputs[i];
  }
  changed_ = true;
}

void StateProjection::apply(const double* times, const double* taken, double* states) {
  if (changed_) {
    interpreter_.calcParameters();
    interpreter_.calcPhase();
    changed_ = false;
  }
  std::copy_n(times, lanes_, interpreter_.updTime());
  std::copy_n(states, rows_ * lanes_, interpreter_.updState(0));
  interpreter_.calcOutputs();
  for (int row = 0; row < rows_; ++row) {
    const double* const projected = interpreter_.getOutput(row);
    for (int lane = 0; lane < lanes_; ++lane) {
      double& state = states[row * lanes_ + lane];
      state = taken[lane] != 0.0 ? projected[lane] : state;
    }
  }
}

}  // namespace twinmap::lanes
