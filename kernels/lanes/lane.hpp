#pragma once

#include <chrono>

#include "kernels/lanes/output_recorder.hpp"
#include "kernels/lanes/sample.hpp"

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

}  // namespace twinmap::lanes
