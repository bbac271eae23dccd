#include "kernels/lanes/output_recorder.hpp"

#include <algorithm>

namespace twinmap::lanes {

OutputRecorder::OutputRecorder(const Problem& problem, const std::vector<double>& times,
                               const program::Engine& engine)
    : times_(times),
      counts_(problem.counts),
      rows_(problem.getRowCount()),
      lanes_(engine.lanes),
      value_count_(problem.output_count),
      derivative_count_(problem.output_count * static_cast<int>(problem.directions.size())),
      interpreter_(problem.output, engine),
      states_(times.size() * rows_ * lanes_),
      phases_(times.size() * lanes_) {}

void OutputRecorder::keep(int lane, int time, int phase, const double* states) {
  const std::size_t count = times_.size();
  phases_[lane * count + time] = phase;
  double* target = states_.data() + lane * rows_ * count + time;
  for (int row = 0; row < rows_; ++row, target += count) {
    *target = states[row * lanes_ + lane];
  }
}

void OutputRecorder::write(int lane, const Sample& sample) {
  const int count = static_cast<int>(times_.size());
  setSample(sample);
  for (int first = 0; first < count; first += lanes_) {
    setTimes(lane, first, sample);
    interpreter_.calcPhase();
    interpreter_.calcOutputs();
    const int here = std::min(lanes_, count - first);
    for (int i = 0; i < value_count_; ++i) {
      std::copy_n(interpreter_.getOutput(i), here, sample.outputs + i * count + first);
    }
    for (int i = 0; i < derivative_count_; ++i) {
      std::copy_n(interpreter_.getOutput(value_count_ + i), here, sample.derivatives + i * count + first);
    }
  }
}

void OutputRecorder::setSample(const Sample& sample) {
  for (int i = 0; i < counts_.parameters; ++i) {
    std::fill_n(interpreter_.updParameter(i), lanes_, sample.parameters[i]);
  }
  interpreter_.calcParameters();
}

/// The last time again where there are not enough.
void OutputRecorder::setTimes(int lane, int first, const Sample& sample) {
  const int count = static_cast<int>(times_.size());
  for (int k = 0; k < lanes_; ++k) {
    const int time = std::min(first + k, count - 1);
    interpreter_.updTime()[k] = times_[time];
    const Phase& phase = sample.phases[phases_[lane * count + time]];
    for (int i = 0; i < counts_.phase_inputs; ++i) {
      interpreter_.updPhaseInput(i)[k] = phase.inputs[i];
    }
  }
  const int here = std::min(lanes_, count - first);
  for (int row = 0; row < rows_; ++row) {
    const double* const source =
        states_.data() + (lane * rows_ + row) * static_cast<std::size_t>(count) + first;
    double* const target = interpreter_.updState(row);
    std::copy_n(source, here, target);
    std::fill(target + here, target + lanes_, source[here - 1]);
  }
}

}  // namespace twinmap::lanes
