#pragma once

#include <vector>

#include "kernels/lanes/program/symbol.hpp"

namespace twinmap::program {

struct InputCounts {
  int states = 0, parameters = 0, phase_inputs = 0;
};

/// One operation on slots. A slot holds one value of every lane.
struct Instruction {
  int targets[2];   ///< the second one for kSinCos alone
  int operands[3];  ///< as many as the operation has
};

/// Instructions of one operation that follow each other: they cost one dispatch.
struct Run {
  Operation operation;
  int count;
};

struct Segment {
  std::vector<Run> runs;
  std::vector<Instruction> instructions;  ///< of all runs, one after the other
};

struct Literal {
  int slot;
  double value;
};

/// What was recorded, in an order in which it can be carried out. Slots: time, states, parameters and phase
/// inputs first; then literals and what later segments or the outputs need; then what lives within a segment.
/// A segment may be carried out again, and leaves the values of the ones before as they were.
struct Program {
  InputCounts counts;
  int slot_count = 0;
  std::vector<Literal> literals;
  Segment parameter;         ///< what depends on parameters alone: once a sample
  Segment phase;             ///< on parameters and phase inputs: once a phase
  Segment evaluation;        ///< on time or state
  std::vector<int> outputs;  ///< their slots, in the order of compile()'s argument

  int getTimeSlot() const { return 0; }
  int getStateSlot(int index) const { return 1 + index; }
  int getParameterSlot(int index) const { return 1 + counts.states + index; }
  int getPhaseInputSlot(int index) const { return 1 + counts.states + counts.parameters + index; }
};

/// The program that computes `outputs` (symbols of `recorder`, or literals): without what they do not need,
/// products and sums joined to one rounding (fused multiply-add), sine and cosine of one argument to one
/// instruction, equal operations next to each other, slots used again as soon as they are free. `counts` must
/// cover the inputs used (asserted); inputs beyond those only take a slot. Cost: about 1 us a node.
Program compile(Recorder& recorder, const std::vector<Symbol>& outputs, const InputCounts& counts);

}  // namespace twinmap::program
