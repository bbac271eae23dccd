#include "kernels/lanes/integrator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "kernels/lanes/lane.hpp"
#include "kernels/lanes/output_recorder.hpp"
#include "kernels/program/aligned_buffer.hpp"

namespace twinmap::lanes {

using program::AlignedBuffer;
using program::Interpreter;

const StepEngine& getBestEngine() {
  return kSteps8.program.isSupported() ? kSteps8 : kSteps8Of4;
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
  void release(int lane, SampleStream& stream);
  void setPhase(int lane);
  void doRound();
  void plan();
  void evaluateStages();
  void judge(int lane);
  void jump(int lane);
  void keepOutputs();
  bool keepPending(const double* states, double* fractions);
  void advance(int lane);
  void beginSteps(int lane);
  double calcNorm(int lane, const double* rows) const;
  void finishSample(int lane);

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
  double *accepted_ = nullptr, *fractions_ = nullptr, *interpolated_ = nullptr;
  StepArrays arrays_{};
  std::vector<Lane> lanes_;
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
      buffer_(static_cast<std::size_t>(9 * problem.getRowCount() + 8) * count_),
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
  interpolated_ = takeRows(rows);
  for (double** row : {&a.time, &a.step, &a.smallest_pivot, &a.error, &a.factor, &accepted_, &fractions_}) {
    *row = takeRows(1);
  }
  a.absolute_tolerance = absolute_.data();
  a.relative_tolerance = relative_.data();
}

void Integrator::Lanes::run(SampleStream& stream) {
  int active = 0;
  for (int lane = 0; lane < count_; ++lane) {
    active += load(lane, stream) ? 1 : 0;
  }
  while (active > 0) {
    ++statistics_.rounds;
    statistics_.active_lanes += active;
    doRound();
    for (int lane = 0; lane < count_; ++lane) {
      if (lanes_[lane].mode == Mode::kIdle && !lanes_[lane].sample.phases.empty()) {
        release(lane, stream);
        active -= load(lane, stream) ? 0 : 1;
      }
    }
  }
}

/// An idle lane computes along with the others, at a state of zeros.
bool Integrator::Lanes::load(int lane, SampleStream& stream) {
  Lane& l = lanes_[lane];
  const bool loaded = stream.next(l.sample);
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.state[row * count_ + lane] = loaded ? l.sample.initial[row] : 0.0;
    arrays_.slopes[1][row * count_ + lane] = 0.0;
  }
  if (!loaded) {
    l.sample.phases.clear();
    return false;
  }
  for (int i = 0; i < parameters_; ++i) {
    interpreter_.updParameter(i)[lane] = l.sample.parameters[i];
  }
  parameters_changed_ = true;
  l.begin();
  setPhase(lane);
  return true;
}

void Integrator::Lanes::release(int lane, SampleStream& stream) {
  const Lane& l = lanes_[lane];
  statistics_.steps += l.result.steps;
  statistics_.rejected += l.result.rejected;
  stream.finish(l.sample, l.result);
}

void Integrator::Lanes::setPhase(int lane) {
  const Lane& l = lanes_[lane];
  for (int i = 0; i < phase_inputs_; ++i) {
    interpreter_.updPhaseInput(i)[lane] = l.sample.phases[l.phase].inputs[i];
  }
  phase_changed_ = true;
}

void Integrator::Lanes::doRound() {
  plan();
  evaluateStages();
  for (int lane = 0; lane < count_; ++lane) {
    judge(lane);
  }
  keepOutputs();
  engine_.accept(accepted_, arrays_);
  for (int lane = 0; lane < count_; ++lane) {
    if (lanes_[lane].mode != Mode::kIdle) {
      advance(lane);
    }
  }
}

void Integrator::Lanes::plan() {
  for (int lane = 0; lane < count_; ++lane) {
    lanes_[lane].plan();
    arrays_.time[lane] = lanes_[lane].time;
    arrays_.step[lane] = lanes_[lane].planned;
  }
}

void Integrator::Lanes::evaluateStages() {
  if (parameters_changed_) {
    interpreter_.calcParameters();
  }
  if (parameters_changed_ || phase_changed_) {
    interpreter_.calcPhase();
  }
  parameters_changed_ = phase_changed_ = false;
  for (int stage = 2; stage <= 7; ++stage) {
    engine_.prepareStage(stage, arrays_);
    interpreter_.calcOutputs();
  }
  engine_.finish(arrays_);
}

/// Whether the step is accepted, or what has failed.
void Integrator::Lanes::judge(int lane) {
  Lane& l = lanes_[lane];
  const bool is_step = l.mode == Mode::kFirst || l.mode == Mode::kStep;
  const double error = arrays_.error[lane];
  accepted_[lane] = l.mode != Mode::kIdle && error <= 1.0 ? 1.0 : 0.0;
  if (l.mode == Mode::kIdle) {
    return;
  }
  l.result.steps += is_step ? 1 : 0;
  if (arrays_.smallest_pivot[lane] <= 0.0) {
    l.fail(Outcome::kSingular);
  } else if (!is_step && accepted_[lane] == 0.0) {
    l.fail(Outcome::kNonFinite);
  } else if (l.mode == Mode::kBegin && !l.sample.phases[l.phase].begin_slopes.empty() && l.phase > 0) {
    jump(lane);
  }
}

/// The solution is continuous where a phase begins, whenever that is: f- dt + ds- = f+ dt + ds+.
void Integrator::Lanes::jump(int lane) {
  const std::vector<double>& slopes = lanes_[lane].sample.phases[lanes_[lane].phase].begin_slopes;
  for (int j = 0; j < directions_; ++j) {
    for (int i = 0; i < states_; ++i) {
      const int at = i * count_ + lane;
      const double difference = arrays_.slopes[1][at] - arrays_.slopes[7][at];
      arrays_.stage_state[(1 + j) * states_ * count_ + at] += slopes[j] * difference;
    }
  }
}

/// The states at the output times that accepted steps have passed; one time of each lane in a pass.
void Integrator::Lanes::keepOutputs() {
  const int time_count = static_cast<int>(times_.size());
  for (bool pending = true; pending;) {
    pending = false;
    for (int lane = 0; lane < count_; ++lane) {
      const Lane& l = lanes_[lane];
      const bool has =
          accepted_[lane] != 0.0 && l.next_output < time_count && times_[l.next_output] < l.getPlannedEnd();
      fractions_[lane] = has ? (times_[l.next_output] - l.time) / l.planned : -1.0;
      pending = pending || has;
    }
    if (pending) {
      engine_.interpolate(fractions_, arrays_, interpolated_);
    }
    for (int lane = 0; lane < count_; ++lane) {
      if (fractions_[lane] >= 0.0) {
        outputs_.keep(lane, lanes_[lane].next_output++, lanes_[lane].phase, interpolated_);
      }
    }
  }
}

void Integrator::Lanes::advance(int lane) {
  Lane& l = lanes_[lane];
  if (l.result.outcome == Outcome::kDone) {
    const bool jumped =
        l.mode == Mode::kBegin && l.phase > 0 && !l.sample.phases[l.phase].begin_slopes.empty();
    if (jumped) {
      l.mode = Mode::kRestart;
      return;
    }
    if (l.mode == Mode::kBegin || l.mode == Mode::kRestart) {
      beginSteps(lane);
    } else if (accepted_[lane] != 0.0) {
      l.accept(arrays_.factor[lane]);
    } else if (!l.reject(arrays_.error[lane], arrays_.factor[lane])) {
      l.fail(std::isfinite(arrays_.error[lane]) ? Outcome::kStepTooSmall : Outcome::kNonFinite);
    }
  }
  l.result.time = l.time;
  if (l.result.outcome != Outcome::kDone) {
    l.mode = Mode::kIdle;
  } else if (l.time < l.getPhaseEnd()) {
    l.mode = l.isStopped(options_) ? Mode::kIdle : l.mode;
  } else if (l.isInLastPhase()) {
    finishSample(lane);
  } else {
    l.beginPhase(l.phase + 1);
    setPhase(lane);
  }
}

/// The first step is a hundredth of the time that the fastest state takes to change by its own size.
void Integrator::Lanes::beginSteps(int lane) {
  Lane& l = lanes_[lane];
  const double size = calcNorm(lane, arrays_.state);
  const double speed = calcNorm(lane, arrays_.slopes[1]);
  const double length = l.getPhaseEnd() - l.time;
  const double guess = size < 1e-5 || speed < 1e-5 ? 1e-6 : 0.01 * size / speed;
  l.proposed = std::min(guess, 0.01 * length);
  l.was_rejected = false;
  l.mode = Mode::kFirst;
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

void Integrator::Lanes::finishSample(int lane) {
  Lane& l = lanes_[lane];
  for (; l.next_output < static_cast<int>(times_.size()); ++l.next_output) {
    outputs_.keep(lane, l.next_output, l.phase, arrays_.state);
  }
  outputs_.write(lane, l.sample);
  l.mode = Mode::kIdle;
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
