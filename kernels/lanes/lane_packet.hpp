#pragma once

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/lanes/event_programs.hpp"
#include "kernels/lanes/output_recorder.hpp"
#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/aligned_buffer.hpp"
#include "kernels/lanes/sample.hpp"
#include "kernels/lanes/sample_stream.hpp"
#include "kernels/lanes/state_projection.hpp"
#include "kernels/lanes/step_engine.hpp"

namespace twinmap::lanes {

/// What a lane's next step is for.
enum class Mode {
  kIdle,
  kBegin,  ///< nothing yet: a phase begins (LanePacket::doBegins)
  kEvent,  ///< nothing yet: an event is due (LanePacket::doEvents)
  kStep,
};

/// One sample on its way; what changes at every step lies in StepArrays.
struct Lane {
  Mode mode = Mode::kIdle;
  bool is_occupied = false;  ///< by a sample, also one that has ended
  Sample sample;
  Result result;
  int phase = 0;
  std::vector<OutputRecorder::KeptTime> kept;  ///< in their order
  int next_output = 0;                         ///< first of them not yet kept
  std::chrono::steady_clock::time_point start{};
  int event = kNoEvent;              ///< the guard of the event that is due
  std::vector<double> event_slopes;  ///< d its time / d parameter; empty: nothing moves it
  std::vector<char> crossing;        ///< guards that the step's end, found by them, no longer leaves positive
  std::vector<char> fired;           ///< guards whose event has been at this time
  double event_time = 0.0;           ///< of the last event found in a step, s
  int events_at_once = 0;            ///< without progress in time

  static constexpr int kNoEvent = -2, kStartEvent = -1;

  const Phase& getPhase() const { return sample.phases[phase]; }
  bool isInLastPhase() const { return phase + 1 == sample.phases.size(); }
  double getPhaseEnd() const { return isInLastPhase() ? sample.end : sample.phases[phase + 1].begin; }
  /// How the time of what jumps, or of the phase's begin, moves with each parameter; null: not at all.
  const std::vector<double>* findJumpSlopes() const {
    const std::vector<double>& slopes = mode == Mode::kEvent ? event_slopes : getPhase().begin_slopes;
    return slopes.empty() || (mode != Mode::kEvent && phase == 0) ? nullptr : &slopes;
  }
};

/// Parts of a step between which a function stops being positive; narrowed by regula falsi with halved values
/// (Illinois) and every third time by bisection, which bounds the number of tries whatever the function.
struct EventBracket {
  double low = 0.0, high = 1.0;
  double at_low = 0.0;   ///< positive; 0: not known, where an event has just been
  double at_high = 0.0;  ///< not positive
  int side = 0;          ///< of the last try: -1 low, 1 high

  double choose(int attempt) const {
    const double middle = 0.5 * (low + high);
    if (!(at_low > 0.0) || attempt % 3 == 2) {
      return middle;
    }
    const double secant = high - at_high * (high - low) / (at_high - at_low);
    return secant > low && secant < high ? secant : middle;
  }

  void update(double fraction, double value) {
    const int now = value > 0.0 ? -1 : 1;
    (now < 0 ? low : high) = fraction;
    (now < 0 ? at_low : at_high) = value;
    if (now == side) {
      (now < 0 ? at_high : at_low) *= 0.5;
    }
    side = now;
  }
};

/// The lanes of one integrator: which samples they hold, and a step of all of them at a time.
class LanePacket {
 public:
  LanePacket(const Problem& problem, const std::vector<double>& times, const Options& options,
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
  void doBegins();
  void restart(unsigned lanes, unsigned jumping, program::Interpreter* jumps);
  void jump(unsigned lanes, program::Interpreter& program);
  void prepareJump(int lane, program::Interpreter& program);
  void evaluateAt(unsigned lanes);
  void beginAfter(int lane);
  unsigned findMoving(unsigned lanes) const;
  void moveBy(int lane, double sign);
  unsigned findEvents();
  unsigned findDips(unsigned looking, unsigned found);
  void calcGuardsWithin();
  void narrow(unsigned lanes);
  void endStepAtEvent(int lane);
  void startEvent(int lane, int event);
  void openPhase(int lane);
  void doEvents();
  void settle(unsigned lanes);
  void findEventSlopes(int lane);
  void keepOutputs(int lane);
  void advance(int lane);
  void beginSteps(int lane);
  void endPhase(int lane);
  void checkLimits(int lane);
  void fail(int lane, Outcome outcome);
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
  program::Interpreter interpreter_;
  OutputRecorder outputs_;
  std::optional<program::Interpreter> jumps_;
  unsigned beginning_ = 0;  ///< lanes whose phase begins before the next step
  std::optional<EventPrograms> events_;
  unsigned firing_ = 0;    ///< lanes with an event due
  unsigned settling_ = 0;  ///< lanes in which events may be due
  std::vector<EventBracket> brackets_;
  std::vector<double> event_times_;
  std::vector<double> dips_;  ///< of the looks of a step, each of all lanes
  std::optional<StateProjection> projection_;
  std::vector<const double*> derivatives_, pivots_;
  std::vector<double> absolute_, relative_;
  program::AlignedBuffer buffer_;
  double* free_ = nullptr;
  StepArrays arrays_{};
  std::vector<Lane> lanes_;
  int active_ = 0;
  bool parameters_changed_ = true, phase_changed_ = true;
  Statistics statistics_;
};

}  // namespace twinmap::lanes
