#include "kernels/lanes/integrator.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/lanes/lane.hpp"
#include "kernels/lanes/output_recorder.hpp"
#include "kernels/program/aligned_buffer.hpp"

namespace twinmap::lanes {

using program::AlignedBuffer;
using program::Interpreter;

namespace {

constexpr int kSingleRows = 13;  // of StepArrays
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFirstGrowth = 100.0;   // the first size is a hundredth of the solution's own time, or less
constexpr int kStepsBetweenClocks = 64;  // reading the clock costs as much as some instructions of all lanes

}  // namespace

const StepEngine& chooseEngine(int samples) {
  const bool has_wide = kSteps8.program.isSupported();
  if (samples <= 4) {
    return kSteps4;
  }
  if (has_wide) {
    return samples <= 8 ? kSteps8 : kSteps16;
  }
  return kSteps8Of4;
}

std::vector<const StepEngine*> getEngines() {
  std::vector<const StepEngine*> engines{&kSteps4, &kSteps8, &kSteps8Of4, &kSteps16};
  engines.erase(std::remove_if(engines.begin(), engines.end(),
                               [](const StepEngine* e) { return !e->program.isSupported(); }),
                engines.end());
  return engines;
}

class Integrator::Lanes {
 public:
  Lanes(const Problem& problem, const std::vector<double>& times, const Options& options,
        const StepEngine& engine);
  void run(SampleStream& stream);
  const Statistics& getStatistics() const { return statistics_; }

 private:
  void makeTolerances(const Problem& problem);
  void placeArrays(const Problem& problem);
  double* takeRows(int count) { return std::exchange(free_, free_ + count * count_); }

  bool load(int lane, SampleStream& stream);
  void park(int lane);
  void release(int lane, SampleStream& stream);
  void beginPhase(int lane, int phase);
  void doRound();
  unsigned doStep();
  void judge(int lane);
  void jump(int lane);
  void keepOutputs(unsigned lanes);
  void advance(int lane);
  void beginSteps(int lane);
  void endPhase(int lane);
  void checkLimits(int lane);
  double calcNorm(int lane, const double* rows) const;
  void setNextOutput(int lane, int index);

  template <typename Function>
  void forEach(unsigned lanes, const Function& function) {
    for (int lane = 0; lanes != 0; ++lane, lanes >>= 1) {
      if ((lanes & 1) != 0 && lanes_[lane].mode != Mode::kIdle) {
        function(lane);
      }
    }
  }

  const std::vector<double> times_;
  const Options options_;
  const StepEngine& engine_;
  const int count_;  ///< lanes
  const int states_, parameters_, phase_inputs_, directions_;
  Interpreter interpreter_;
  OutputRecorder outputs_;
  std::vector<const double*> derivatives_, pivots_;
  std::vector<double> absolute_, relative_;
  AlignedBuffer buffer_;
  double* free_ = nullptr;
  StepArrays arrays_{};
  std::vector<Lane> lanes_;
  int active_ = 0;
  bool parameters_changed_ = true, phase_changed_ = true;
  Statistics statistics_;
};

Integrator::Lanes::Lanes(const Problem& problem, const std::vector<double>& times, const Options& options,
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
  makeTolerances(problem);
  placeArrays(problem);
}

void Integrator::Lanes::makeTolerances(const Problem& problem) {
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

void Integrator::Lanes::placeArrays(const Problem& problem) {
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
  for (double** row : {&a.fraction, &a.time, &a.step, &a.end, &a.smallest_pivot, &a.error, &a.accepted,
                       &a.proposed, &a.growth, &a.phase_end, &a.next_output, &a.steps, &a.next_check}) {
    *row = takeRows(1);
  }
  a.absolute_tolerance = absolute_.data();
  a.relative_tolerance = relative_.data();
}

void Integrator::Lanes::run(SampleStream& stream) {
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

bool Integrator::Lanes::load(int lane, SampleStream& stream) {
  Lane& l = lanes_[lane];
  park(lane);
  l.is_occupied = stream.next(l.sample);
  if (!l.is_occupied) {
    return false;
  }
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.state[row * count_ + lane] = l.sample.initial[row];
  }
  for (int i = 0; i < parameters_; ++i) {
    interpreter_.updParameter(i)[lane] = l.sample.parameters[i];
  }
  parameters_changed_ = true;
  l.result = {};
  l.start = std::chrono::steady_clock::now();
  arrays_.next_check[lane] = 0.0;
  setNextOutput(lane, 0);
  beginPhase(lane, 0);
  return true;
}

/// An idle lane takes steps of size 0 at a state of zeros.
void Integrator::Lanes::park(int lane) {
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.state[row * count_ + lane] = 0.0;
    arrays_.slopes[1][row * count_ + lane] = 0.0;
  }
  arrays_.time[lane] = arrays_.proposed[lane] = arrays_.steps[lane] = 0.0;
  arrays_.phase_end[lane] = arrays_.next_output[lane] = arrays_.next_check[lane] = kInfinity;
}

void Integrator::Lanes::release(int lane, SampleStream& stream) {
  Lane& l = lanes_[lane];
  l.result.time = arrays_.time[lane];
  l.result.steps = static_cast<int>(arrays_.steps[lane]);
  statistics_.steps += l.result.steps;
  statistics_.rejected += l.result.rejected;
  stream.finish(l.sample, l.result);
}

void Integrator::Lanes::beginPhase(int lane, int phase) {
  Lane& l = lanes_[lane];
  l.phase = phase;
  l.mode = Mode::kBegin;
  for (int i = 0; i < phase_inputs_; ++i) {
    interpreter_.updPhaseInput(i)[lane] = l.getPhase().inputs[i];
  }
  phase_changed_ = true;
  arrays_.time[lane] = l.getPhase().begin;
  arrays_.phase_end[lane] = l.getPhaseEnd();
  arrays_.proposed[lane] = 0.0;
}

void Integrator::Lanes::doRound() {
  const unsigned attention = doStep();
  forEach(attention, [this](int lane) { judge(lane); });
  keepOutputs(attention);
  engine_.accept(arrays_);
  forEach(attention, [this](int lane) { advance(lane); });
}

unsigned Integrator::Lanes::doStep() {
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

/// Before the new state is taken: what has failed, and where it has to be corrected.
void Integrator::Lanes::judge(int lane) {
  Lane& l = lanes_[lane];
  if (arrays_.smallest_pivot[lane] <= 0.0) {
    l.fail(Outcome::kSingular);
    arrays_.accepted[lane] = 0.0;
  } else if (l.mode != Mode::kStep && arrays_.accepted[lane] == 0.0) {
    l.fail(Outcome::kNonFinite);
  } else if (l.mode == Mode::kBegin && l.hasJump()) {
    jump(lane);
  }
}

/// The solution is continuous where a phase begins, whenever that is: f- dt + ds- = f+ dt + ds+.
void Integrator::Lanes::jump(int lane) {
  const std::vector<double>& slopes = lanes_[lane].getPhase().begin_slopes;
  for (int j = 0; j < directions_; ++j) {
    for (int i = 0; i < states_; ++i) {
      const int at = i * count_ + lane;
      const double difference = arrays_.slopes[1][at] - arrays_.slopes[7][at];
      arrays_.stage_state[(1 + j) * states_ * count_ + at] += slopes[j] * difference;
    }
  }
}

/// The states at the output times that accepted steps have passed; one time of each lane in a pass.
void Integrator::Lanes::keepOutputs(unsigned lanes) {
  const StepArrays& a = arrays_;
  const auto isPending = [&a](int lane) {
    return a.accepted[lane] != 0.0 && a.next_output[lane] < a.end[lane];
  };
  for (;;) {
    unsigned pending = 0;
    forEach(lanes, [&](int lane) {
      pending |= isPending(lane) ? 1u << lane : 0u;
      a.fraction[lane] = isPending(lane) ? (a.next_output[lane] - a.time[lane]) / a.step[lane] : 0.0;
    });
    if (pending == 0) {
      return;
    }
    engine_.interpolate(a);
    forEach(pending, [this](int lane) {
      outputs_.keep(lane, lanes_[lane].next_output, lanes_[lane].phase, arrays_.interpolated);
      setNextOutput(lane, lanes_[lane].next_output + 1);
    });
  }
}

void Integrator::Lanes::setNextOutput(int lane, int index) {
  lanes_[lane].next_output = index;
  arrays_.next_output[lane] = index < static_cast<int>(times_.size()) ? times_[index] : kInfinity;
}

void Integrator::Lanes::advance(int lane) {
  Lane& l = lanes_[lane];
  if (l.mode == Mode::kBegin && l.hasJump()) {
    l.mode = Mode::kRestart;
  } else if (l.mode != Mode::kStep) {
    beginSteps(lane);
  } else if (arrays_.time[lane] == arrays_.phase_end[lane]) {
    endPhase(lane);
  } else {
    l.result.rejected += arrays_.accepted[lane] == 0.0 ? 1 : 0;
    const double time = std::max(std::abs(arrays_.time[lane]), kSmallestTime);
    if (arrays_.proposed[lane] <= kSmallestStep * time) {
      l.fail(std::isfinite(arrays_.error[lane]) ? Outcome::kStepTooSmall : Outcome::kNonFinite);
    }
  }
  if (l.mode == Mode::kStep) {
    checkLimits(lane);
  }
}

/// The first step is a hundredth of the time that the fastest state takes to change by its own size.
void Integrator::Lanes::beginSteps(int lane) {
  const double size = calcNorm(lane, arrays_.state);
  const double speed = calcNorm(lane, arrays_.slopes[1]);
  const double length = arrays_.phase_end[lane] - arrays_.time[lane];
  const double guess = size < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01 * size / speed;
  arrays_.proposed[lane] = std::min(guess, 0.01 * length);
  arrays_.growth[lane] = kFirstGrowth;
  lanes_[lane].mode = Mode::kStep;
}

double Integrator::Lanes::calcNorm(int lane, const double* rows) const {
  double largest = 0.0;
  for (int row = 0; row < arrays_.rows; ++row) {
    const int at = row * count_ + lane;
    const double scale = absolute_[row] + relative_[row] * std::abs(arrays_.state[at]);
    largest = std::max(largest, std::abs(rows[at]) / scale);
  }
  return largest;
}

void Integrator::Lanes::endPhase(int lane) {
  Lane& l = lanes_[lane];
  if (!l.isInLastPhase()) {
    beginPhase(lane, l.phase + 1);
    return;
  }
  for (; l.next_output < static_cast<int>(times_.size()); ++l.next_output) {
    outputs_.keep(lane, l.next_output, l.phase, arrays_.state);
  }
  outputs_.write(lane, l.sample);
  l.mode = Mode::kIdle;
}

void Integrator::Lanes::checkLimits(int lane) {
  Lane& l = lanes_[lane];
  const double steps = arrays_.steps[lane];
  if (steps >= options_.max_steps) {
    l.fail(Outcome::kStepLimit);
  } else if (steps >= arrays_.next_check[lane]) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - l.start;
    if (elapsed.count() > options_.max_wall_time) {
      l.fail(Outcome::kWallTime);
    }
    arrays_.next_check[lane] = std::min(steps + kStepsBetweenClocks, static_cast<double>(options_.max_steps));
  }
}

Integrator::Integrator(const Problem& problem, const std::vector<double>& times, const Options& options,
                       const StepEngine& engine)
    : lanes_(std::make_unique<Lanes>(problem, times, options, engine)) {}
Integrator::~Integrator() = default;

void Integrator::run(SampleStream& stream) {
  lanes_->run(stream);
}

const Statistics& Integrator::getStatistics() const {
  return lanes_->getStatistics();
}

namespace {

class ListedSamples : public SampleStream {
 public:
  explicit ListedSamples(const std::vector<Sample>& samples) : samples_(samples), results(samples.size()) {}
  bool next(Sample& sample) override {
    if (next_ == samples_.size()) {
      return false;
    }
    sample = samples_[next_];
    sample.index = static_cast<int>(next_++);
    return true;
  }
  void finish(const Sample& sample, const Result& result) override { results[sample.index] = result; }

 private:
  const std::vector<Sample>& samples_;
  std::size_t next_ = 0;

 public:
  std::vector<Result> results;
};

}  // namespace

std::vector<Result> integrate(Integrator& integrator, const std::vector<Sample>& samples) {
  ListedSamples stream(samples);
  integrator.run(stream);
  return stream.results;
}

}  // namespace twinmap::lanes
