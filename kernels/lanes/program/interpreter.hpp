#pragma once

#include <memory>
#include <vector>

#include "kernels/lanes/program/aligned_buffer.hpp"
#include "kernels/lanes/program/engine.hpp"
#include "kernels/lanes/program/program.hpp"

namespace twinmap::program {

/// All engines of this processor; all give the same bits.
std::vector<const Engine*> getEngines();

/// Carries out a program for many samples at a time, one a lane. Rows are arrays of getLanes() doubles, at a
/// multiple of 32 bytes, and stay where they are. No lane's values depend on another lane's.
class Interpreter {
 public:
  /// Slots that the 16 bits of a place reach with an engine: 16384 with 16 lanes, 65536 with 4.
  static int countReachable(const Engine& engine) { return 0x10000 * kPlace / engine.lanes; }

  /// Throws std::length_error for a program of more than countReachable() slots.
  explicit Interpreter(const Program& program, const Engine& engine = kEngine4);

  int getLanes() const { return engine_->lanes; }
  double* updTime() { return updRow(time_); }
  double* updState(int index) { return updRow(time_ + 1 + index); }
  double* updParameter(int index) { return updRow(time_ + 1 + counts_.states + index); }
  double* updPhaseInput(int index) { return updRow(time_ + 1 + counts_.states + counts_.parameters + index); }
  const double* getOutput(int index) const { return slots_.get() + outputs_[index]; }

  /// After parameters changed; calcPhase() must follow.
  void calcParameters() { run(parameter_); }
  /// After phase inputs changed.
  void calcPhase() { run(phase_); }
  /// The outputs at the present time and states.
  void calcOutputs() { run(evaluation_); }

 private:
  struct PlacedSegment {
    std::vector<PlacedRun> runs;
    std::vector<PlacedInstruction> instructions;
  };
  double* updRow(int slot) { return slots_.get() + slot * engine_->lanes; }
  PlacedSegment place(const Segment& segment) const;
  void run(const PlacedSegment& segment) {
    engine_->run(segment.runs.data(), segment.runs.data() + segment.runs.size(), segment.instructions.data(),
                 slots_.get());
  }

  const Engine* engine_;
  InputCounts counts_;
  int time_;
  std::vector<std::size_t> outputs_;
  PlacedSegment parameter_, phase_, evaluation_;
  AlignedBuffer slots_;
};

}  // namespace twinmap::program
