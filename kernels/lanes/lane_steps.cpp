// A step of all lanes, and what single lanes need after it.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "kernels/lanes/lane_packet.hpp"

namespace twinmap::lanes {
namespace {

constexpr double kFirstGrowth = 100.0;   // the first size is a hundredth of the solution's own time, or less
constexpr int kStepsBetweenClocks = 64;  // reading the clock costs as much as some instructions of all lanes

}  // namespace

void LanePacket::doRound() {
  while ((beginning_ | firing_ | settling_) != 0) {
    if (beginning_ != 0) {
      doBegins();
    }
    if ((firing_ | settling_) != 0) {
      doEvents();
    }
  }
  unsigned attention = doStep();
  forEach(attention, [this](int lane) { judge(lane); });
  if (events_) {
    attention |= findEvents();
  }
  forEach(attention, [this](int lane) { keepOutputs(lane); });
  if (projection_) {
    // the slopes stay those of the state before, which is as near as the step's error: they enter the next
    // step as if that had begun with this error
    projection_->apply(arrays_.end, arrays_.accepted, arrays_.stage_state);
  }
  engine_.accept(arrays_);
  forEach(attention, [this](int lane) { advance(lane); });
}

unsigned LanePacket::doStep() {
  if (parameters_changed_) {
    interpreter_.calcParameters();
  }
  if (parameters_changed_ || phase_changed_) {
    interpreter_.calcPhase();
  }
  parameters_changed_ = phase_changed_ = false;
  engine_.plan(arrays_);
  for (int stage = 2; stage <= 7; ++stage) {
    engine_.prepareStage(stage, arrays_);
    interpreter_.calcOutputs();
  }
  return engine_.finish(arrays_);
}

/// Before the new state is taken: what has failed.
void LanePacket::judge(int lane) {
  if (arrays_.smallest_pivot[lane] <= 0.0) {
    fail(lane, Outcome::kSingular);
  }
}

/// The states of a lane at the output times that its accepted step has passed.
void LanePacket::keepOutputs(int lane) {
  const StepArrays& a = arrays_;
  const Lane& l = lanes_[lane];
  const int count = static_cast<int>(l.kept.size());
  while (a.accepted[lane] != 0.0 && a.next_output[lane] < a.end[lane]) {
    int last = l.next_output;
    for (int i = 0; i < engine_.times; ++i) {
      const bool passed = last < count && l.kept[last].time < a.end[lane];
      a.wanted[i] = passed ? l.kept[last].time : a.time[lane];
      last += passed ? 1 : 0;
    }
    engine_.interpolate(lane, a);
    outputs_.keep(lane, &l.kept[l.next_output], last - l.next_output, l.phase,
                  {a.interpolated, engine_.times});
    setNextOutput(lane, last);
  }
}

void LanePacket::advance(int lane) {
  Lane& l = lanes_[lane];
  if (l.mode == Mode::kEvent) {
    return;
  }
  if (arrays_.time[lane] == arrays_.phase_end[lane]) {
    endPhase(lane);
  } else {
    l.result.rejected += arrays_.accepted[lane] == 0.0 ? 1 : 0;
    const double time = std::max(std::abs(arrays_.time[lane]), kSmallestTime);
    if (arrays_.proposed[lane] <= kSmallestStep * time) {
      fail(lane, std::isfinite(arrays_.error[lane]) ? Outcome::kStepTooSmall : Outcome::kNonFinite);
    }
  }
  if (l.mode != Mode::kIdle) {
    checkLimits(lane);
  }
}

/// The first step is a hundredth of the time that the fastest state takes to change by its own size. A phase
/// as short as rounding, between two events that mean the same time, is one step.
void LanePacket::beginSteps(int lane) {
  const double size = calcNorm(lane, arrays_.state);
  const double speed = calcNorm(lane, arrays_.slopes[1]);
  const double length = arrays_.phase_end[lane] - arrays_.time[lane];
  const double guess = size < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01 * size / speed;
  const double time = std::max(std::abs(arrays_.time[lane]), kSmallestTime);
  arrays_.proposed[lane] = std::max(std::min(guess, 0.01 * length), 2.0 * kSmallestStep * time);
  arrays_.growth[lane] = kFirstGrowth;
  lanes_[lane].mode = Mode::kStep;
}

double LanePacket::calcNorm(int lane, const double* rows) const {
  double largest = 0.0;
  for (int row = 0; row < arrays_.rows; ++row) {
    const int at = row * count_ + lane;
    const double scale = absolute_[row] + relative_[row] * std::abs(arrays_.state[at]);
    largest = std::max(largest, std::abs(rows[at]) / scale);
  }
  return largest;
}

void LanePacket::endPhase(int lane) {
  Lane& l = lanes_[lane];
  if (!l.isInLastPhase()) {
    beginPhase(lane, l.phase + 1);
    return;
  }
  for (; l.next_output < static_cast<int>(l.kept.size()); ++l.next_output) {
    outputs_.keep(lane, &l.kept[l.next_output], 1, l.phase, {arrays_.state + lane, count_});
  }
  outputs_.write(lane, l.sample);
  l.mode = Mode::kIdle;
}

void LanePacket::checkLimits(int lane) {
  Lane& l = lanes_[lane];
  const double steps = arrays_.steps[lane];
  if (steps >= options_.max_steps) {
    fail(lane, Outcome::kStepLimit);
  } else if (steps >= arrays_.next_check[lane]) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - l.start;
    if (elapsed.count() > options_.max_wall_time) {
      fail(lane, Outcome::kWallTime);
    }
    arrays_.next_check[lane] = std::min(steps + kStepsBetweenClocks, static_cast<double>(options_.max_steps));
  }
}

/// The lane stays where it is.
void LanePacket::fail(int lane, Outcome outcome) {
  lanes_[lane].result.outcome = outcome;
  lanes_[lane].mode = Mode::kIdle;
  arrays_.accepted[lane] = arrays_.proposed[lane] = 0.0;
}

}  // namespace twinmap::lanes
