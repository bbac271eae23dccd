#pragma once

#include <chrono>

#include "kernels/lanes/sample.hpp"

namespace twinmap::lanes {

/// What a lane's next step of the packet is for.
enum class Mode {
  kIdle,
  kBegin,    ///< a step of size 0, whose last slopes are those at the phase's begin
  kRestart,  ///< once more, since the sensitivities have jumped there
  kFirst,    ///< the first step of a phase: its size is a guess
  kStep,
};

/// One sample on its way: where it is and what the step controller knows.
struct Lane {
  Mode mode = Mode::kIdle;
  Sample sample;
  Result result;
  int phase = 0;
  int next_output = 0;    ///< first time not yet kept
  double time = 0.0;      ///< s; the begin of the step
  double proposed = 0.0;  ///< s; size of the step that the error allows
  double planned = 0.0;   ///< s; size of the step in work
  bool is_last = false;   ///< the step in work ends the phase
  bool was_rejected = false;
  std::chrono::steady_clock::time_point start{};

  /// Takes up the sample that was put in.
  void begin();
  /// Takes up the phase that begins at the present time.
  void beginPhase(int index);
  double getPhaseEnd() const;
  bool isInLastPhase() const { return phase + 1 == static_cast<int>(sample.phases.size()); }

  /// Chooses the size of the next step: up to the phase's end, or half of the way there at most.
  void plan();
  double getPlannedEnd() const { return is_last ? getPhaseEnd() : time + planned; }

  /// The controller's answers; `factor` is by what it wants to change the step.
  void accept(double factor);
  /// False if the next step would be too small.
  bool reject(double error, double factor);

  /// Whether options forbid another step; sets the outcome.
  bool isStopped(const Options& options);
  void fail(Outcome outcome);
};

}  // namespace twinmap::lanes
