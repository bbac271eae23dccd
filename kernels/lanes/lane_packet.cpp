// Which samples the lanes hold.
#include "kernels/lanes/lane_packet.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <limits>

namespace twinmap::lanes {
namespace {

constexpr int kSingleRows = 14;  // of StepArrays
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

LanePacket::LanePacket(const Problem& problem, const std::vector<double>& times, const Options& options,
                       const StepEngine& engine)
    : times_(times),
      options_(options),
      engine_(engine),
      count_(engine.program.lanes),
      states_(problem.counts.states),
      parameters_(problem.counts.parameters),
      phase_inputs_(problem.counts.phase_inputs),
      directions_(static_cast<int>(problem.directions.size())),
      interpreter_(problem.derivative, engine.program),
      outputs_(problem, times, engine.program),
      buffer_(static_cast<std::size_t>(9 * problem.getRowCount() + kSingleRows) * count_),
      lanes_(count_) {
  if (!problem.jump.outputs.empty()) {
    jumps_.emplace(problem.jump, engine.program);
  }
  if (problem.guard_count > 0) {
    events_.emplace(problem, engine.program);
    brackets_.resize(count_);
    event_times_.resize(count_);
  }
  if (!problem.projection.outputs.empty()) {
    projection_.emplace(problem, engine.program);
  }
  makeTolerances(problem);
  placeArrays(problem);
}

void LanePacket::makeTolerances(const Problem& problem) {
  const int rows = problem.getRowCount();
  absolute_.assign(rows, options_.absolute_tolerance);
  relative_.assign(rows, options_.relative_tolerance);
  for (int row = states_; row < rows; ++row) {
    const int direction = row / states_ - 1;
    const double scale = options_.parameter_scales.empty() ? 1.0 : options_.parameter_scales[direction];
    absolute_[row] *= options_.sensitivity_factor / scale;
    relative_[row] *= options_.sensitivity_factor;
  }
}

void LanePacket::placeArrays(const Problem& problem) {
  const int rows = problem.getRowCount();
  for (int i = 0; i < rows; ++i) {
    derivatives_.push_back(interpreter_.getOutput(i));
  }
  for (int i = 0; i < problem.pivot_count; ++i) {
    pivots_.push_back(interpreter_.getOutput(rows + i));
  }
  free_ = buffer_.get();
  StepArrays& a = arrays_;
  a.rows = rows;
  a.pivots = problem.pivot_count;
  a.derivatives = derivatives_.data();
  a.pivot_values = pivots_.data();
  a.stage_state = interpreter_.updState(0);
  a.stage_time = interpreter_.updTime();
  a.state = takeRows(rows);
  for (int j = 1; j <= 7; ++j) {
    a.slopes[j] = takeRows(rows);
  }
  a.interpolated = takeRows(rows);
  for (double** row :
       {&a.wanted, &a.fraction, &a.time, &a.step, &a.end, &a.smallest_pivot, &a.error, &a.accepted,
        &a.proposed, &a.growth, &a.phase_end, &a.next_output, &a.steps, &a.next_check}) {
    *row = takeRows(1);
  }
  a.absolute_tolerance = absolute_.data();
  a.relative_tolerance = relative_.data();
}

void LanePacket::run(SampleStream& stream) {
  for (int lane = 0; lane < count_; ++lane) {
    active_ += load(lane, stream) ? 1 : 0;
  }
  while (active_ > 0) {
    ++statistics_.rounds;
    statistics_.active_lanes += active_;
    doRound();
    for (int lane = 0; lane < count_; ++lane) {
      if (lanes_[lane].mode == Mode::kIdle && lanes_[lane].is_occupied) {
        release(lane, stream);
        active_ -= load(lane, stream) ? 0 : 1;
      }
    }
  }
}

bool LanePacket::load(int lane, SampleStream& stream) {
  Lane& l = lanes_[lane];
  park(lane);
  l.is_occupied = stream.next(l.sample);
  if (!l.is_occupied) {
    return false;
  }
  assert(static_cast<int>(l.sample.initial.size()) == arrays_.rows && !l.sample.phases.empty());
  assert(static_cast<int>(l.sample.parameters.size()) == parameters_);
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.state[row * count_ + lane] = l.sample.initial[row];
  }
  for (int i = 0; i < parameters_; ++i) {
    interpreter_.updParameter(i)[lane] = l.sample.parameters[i];
  }
  parameters_changed_ = true;
  if (projection_) {
    projection_->setSample(lane, l.sample);
  }
  if (events_) {
    events_->setSample(lane, l.sample);
    l.event_time = -kInfinity;
    l.crossing.assign(events_->getCount(), 0);
  }
  l.result = {};
  l.start = std::chrono::steady_clock::now();
  arrays_.next_check[lane] = 0.0;
  if (l.kept.empty() || !l.sample.delays.empty()) {
    l.kept = outputs_.listKeptTimes(l.sample);
  }
  setNextOutput(lane, 0);
  beginPhase(lane, 0);
  return true;
}

/// An idle lane takes steps of size 0 at a state of zeros.
void LanePacket::park(int lane) {
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.state[row * count_ + lane] = 0.0;
    arrays_.slopes[1][row * count_ + lane] = 0.0;
  }
  arrays_.time[lane] = arrays_.proposed[lane] = arrays_.steps[lane] = 0.0;
  arrays_.phase_end[lane] = arrays_.next_output[lane] = arrays_.next_check[lane] = kInfinity;
}

void LanePacket::release(int lane, SampleStream& stream) {
  Lane& l = lanes_[lane];
  l.result.time = arrays_.time[lane];
  l.result.steps = static_cast<int>(arrays_.steps[lane]);
  statistics_.steps += l.result.steps;
  statistics_.rejected += l.result.rejected;
  stream.finish(l.sample, l.result);
}

void LanePacket::beginPhase(int lane, int phase) {
  Lane& l = lanes_[lane];
  l.phase = phase;
  l.mode = Mode::kBegin;
  beginning_ |= 1u << lane;
  for (int i = 0; i < phase_inputs_; ++i) {
    interpreter_.updPhaseInput(i)[lane] = l.getPhase().inputs[i];
  }
  phase_changed_ = true;
  if (projection_) {
    projection_->setPhase(lane, l.getPhase());
  }
  if (events_) {
    events_->setPhase(lane, l.getPhase());
    l.events_at_once = 0;
    l.fired.assign(events_->getCount(), 0);
    std::fill(l.crossing.begin(), l.crossing.end(), 0);
    l.event_slopes = phase > 0 ? l.getPhase().begin_slopes : std::vector<double>{};
  }
  assert(static_cast<int>(l.getPhase().inputs.size()) == phase_inputs_ &&
         l.getPhase().begin < l.getPhaseEnd());
  arrays_.time[lane] = l.getPhase().begin;
  arrays_.phase_end[lane] = l.getPhaseEnd();
}

void LanePacket::setNextOutput(int lane, int index) {
  lanes_[lane].next_output = index;
  const std::vector<OutputRecorder::KeptTime>& kept = lanes_[lane].kept;
  arrays_.next_output[lane] = index < static_cast<int>(kept.size()) ? kept[index].time : kInfinity;
}

}  // namespace twinmap::lanes
