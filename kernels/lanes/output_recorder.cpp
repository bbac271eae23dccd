#include "kernels/lanes/output_recorder.hpp"

#include <algorithm>

namespace twinmap::lanes {

OutputRecorder::OutputRecorder(const Problem& problem, const std::vector<double>& times,
                               const program::Engine& engine)
    : times_(times),
      output_delays_(problem.output_delays),
      delay_count_(problem.delay_count),
      counts_(problem.counts),
      rows_(problem.getRowCount()),
      lanes_(engine.lanes),
      value_count_(problem.output_count),
      derivative_count_(problem.output_count * static_cast<int>(problem.directions.size())),
      interpreter_(problem.output, engine),
      states_((1 + delay_count_) * times.size() * rows_ * lanes_),
      phases_((1 + delay_count_) * times.size() * lanes_) {
  for (const int slot : problem.output.outputs) {
    const int state = slot - problem.output.getStateSlot(0);
    copied_.push_back(state >= 0 && state < rows_ ? state : -1);
  }
  all_copied_ = std::all_of(copied_.begin(), copied_.end(), [](int state) { return state >= 0; });
}

std::vector<OutputRecorder::KeptTime> OutputRecorder::listKeptTimes(const Sample& sample) const {
  const int count = static_cast<int>(times_.size());
  std::vector<KeptTime> kept;
  for (int delay = -1; delay < delay_count_; ++delay) {
    for (int i = 0; i < count; ++i) {
      kept.push_back({calcTime(sample, delay, i), (1 + delay) * count + i});
    }
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const KeptTime& a, const KeptTime& b) { return a.time < b.time; });
  return kept;
}

double OutputRecorder::calcTime(const Sample& sample, int delay, int time) const {
  return delay < 0 ? times_[time] : std::max(times_[time] - sample.delays[delay], sample.phases[0].begin);
}

void OutputRecorder::keep(int lane, const KeptTime* kept, int count, int phase, const States& states) {
  const std::size_t places = (1 + delay_count_) * times_.size();
  for (int i = 0; i < count; ++i) {
    phases_[lane * places + kept[i].place] = phase;
  }
  double* target = states_.data() + lane * rows_ * places;
  for (int row = 0; row < rows_; ++row, target += places) {
    for (int i = 0; i < count; ++i) {
      target[kept[i].place] = states.values[row * states.stride + i];
    }
  }
}

void OutputRecorder::write(int lane, const Sample& sample) {
  copyStates(lane, sample);
  if (all_copied_) {
    return;
  }
  setSample(sample);
  for (int delay = -1; delay < delay_count_; ++delay) {
    writeDelayed(lane, delay, sample);
  }
}

void OutputRecorder::copyStates(int lane, const Sample& sample) {
  const std::size_t count = times_.size(), places = (1 + delay_count_) * count;
  for (int i = 0; i < value_count_ + derivative_count_; ++i) {
    if (const int state = copied_[i]; state >= 0) {
      const int delay = output_delays_.empty() ? -1 : output_delays_[i % value_count_];
      const double* const source = states_.data() + (lane * rows_ + state) * places + (1 + delay) * count;
      std::copy_n(source, count, getTarget(sample, i));
    }
  }
}

/// The outputs of this delay.
void OutputRecorder::writeDelayed(int lane, int delay, const Sample& sample) {
  const int count = static_cast<int>(times_.size());
  for (int first = 0; first < count; first += lanes_) {
    setTimes(lane, delay, first, sample);
    interpreter_.calcPhase();
    interpreter_.calcOutputs();
    const int here = std::min(lanes_, count - first);
    for (int i = 0; i < value_count_ + derivative_count_; ++i) {
      if (copied_[i] < 0 && has(i % value_count_, delay)) {
        std::copy_n(interpreter_.getOutput(i), here, getTarget(sample, i) + first);
      }
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
void OutputRecorder::setTimes(int lane, int delay, int first, const Sample& sample) {
  const int count = static_cast<int>(times_.size()), places = (1 + delay_count_) * count;
  const int before = (1 + delay) * count;
  for (int k = 0; k < lanes_; ++k) {
    const int time = std::min(first + k, count - 1);
    interpreter_.updTime()[k] = calcTime(sample, delay, time);
    const Phase& phase = sample.phases[phases_[lane * places + before + time]];
    for (int i = 0; i < counts_.phase_inputs; ++i) {
      interpreter_.updPhaseInput(i)[k] = phase.inputs[i];
    }
  }
  const int here = std::min(lanes_, count - first);
  for (int row = 0; row < rows_; ++row) {
    const double* const source =
        states_.data() + (lane * rows_ + row) * static_cast<std::size_t>(places) + before + first;
    double* const target = interpreter_.updState(row);
    std::copy_n(source, here, target);
    std::fill(target + here, target + lanes_, source[here - 1]);
  }
}

}  // namespace twinmap::lanes
