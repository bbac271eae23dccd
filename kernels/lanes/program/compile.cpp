#include <algorithm>
#include <cassert>

#include "kernels/lanes/program/lower.hpp"
#include "kernels/lanes/program/program.hpp"
#include "kernels/lanes/program/recorder.hpp"
#include "kernels/lanes/program/schedule.hpp"

namespace twinmap::program {
namespace {

constexpr Level kSegments[] = {Level::kParameter, Level::kPhase, Level::kEvaluation};

/// Gives every value a slot.
class SlotAllocation {
 public:
  SlotAllocation(const std::vector<Node>& nodes, Program& program)
      : nodes_(nodes), program_(program), slots_(nodes.size(), -1), keep_(nodes.size(), false) {
    const InputCounts& counts = program.counts;
    program_.slot_count = program.getPhaseInputSlot(counts.phase_inputs);
  }

  /// Before assign().
  void keep(int node) {
    if (!keep_[node]) {
      keep_[node] = true;
      slots_[node] = findInputSlot(nodes_[node]);
      if (slots_[node] < 0) {
        slots_[node] = program_.slot_count++;
      }
      if (nodes_[node].operation == Operation::kLiteral) {
        program_.literals.push_back({slots_[node], nodes_[node].literal});
      }
    }
  }

  int getSlot(int node) const { return slots_[node]; }

  /// Slots from the first free one for what lives within the steps. A slot is free after its value's last
  /// use. The one freed last is taken next, since it is the most likely to be in the cache.
  Segment assign(const std::vector<Step>& steps) {
    std::vector<int> last_use(nodes_.size(), -1), free;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (const int operand : steps[i].operands) {
        if (operand >= 0) {
          last_use[operand] = static_cast<int>(i);
        }
      }
    }
    int end = program_.slot_count;
    Segment segment;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      segment.instructions.push_back(assignStep(steps[i], static_cast<int>(i), last_use, free, end));
      if (segment.runs.empty() || segment.runs.back().operation != steps[i].operation) {
        segment.runs.push_back({steps[i].operation, 0});
      }
      ++segment.runs.back().count;
    }
    largest_end_ = std::max(largest_end_, end);
    return segment;
  }

  int getLargestEnd() const { return largest_end_; }

 private:
  int findInputSlot(const Node& node) const {
    const InputCounts& counts = program_.counts;
    switch (node.operation) {
      case Operation::kTime:
        return program_.getTimeSlot();
      case Operation::kState:
        assert(node.a < counts.states);
        return program_.getStateSlot(node.a);
      case Operation::kParameter:
        assert(node.a < counts.parameters);
        return program_.getParameterSlot(node.a);
      case Operation::kPhaseInput:
        assert(node.a < counts.phase_inputs);
        return program_.getPhaseInputSlot(node.a);
      default:
        return -1;
    }
  }

  Instruction assignStep(const Step& step, int index, std::vector<int>& last_use, std::vector<int>& free,
                         int& end) {
    Instruction instruction{{-1, -1}, {-1, -1, -1}};
    for (int k = 0; k < 3; ++k) {
      const int operand = step.operands[k];
      if (operand >= 0) {
        instruction.operands[k] = slots_[operand];
        if (!keep_[operand] && last_use[operand] == index) {
          last_use[operand] = -1;  // an operand may stand twice
          free.push_back(slots_[operand]);
        }
      }
    }
    for (int k = 0; k < 2; ++k) {
      const int result = step.results[k];
      if (result >= 0 && !keep_[result]) {
        slots_[result] = free.empty() ? end++ : free.back();
        if (!free.empty()) {
          free.pop_back();
        }
      }
      instruction.targets[k] = result < 0 ? -1 : slots_[result];
    }
    return instruction;
  }

  const std::vector<Node>& nodes_;
  Program& program_;
  std::vector<int> slots_;
  std::vector<char> keep_;
  int largest_end_ = 0;
};

/// Whether a node lives longer than the steps that use it: it was not made by them.
bool crosses(const Node& node, Level user) {
  return node.level < user || countOperands(node.operation) == 0;
}

}  // namespace

Program compile(Recorder& recorder, const std::vector<Symbol>& outputs, const InputCounts& counts) {
  std::vector<int> wanted;
  for (const Symbol& output : outputs) {
    wanted.push_back(recorder.findNode(output));
  }
  const std::vector<Node>& nodes = recorder.getNodes();
  Steps steps = lower(recorder, wanted);
  Program program;
  program.counts = counts;
  SlotAllocation allocation(nodes, program);
  for (const int node : wanted) {
    allocation.keep(node);
  }
  for (const Level level : kSegments) {
    for (const Step& step : steps.levels[static_cast<int>(level)]) {
      for (const int operand : step.operands) {
        if (operand >= 0 && crosses(nodes[operand], level)) {
          allocation.keep(operand);
        }
      }
    }
  }
  Segment* const segments[] = {&program.parameter, &program.phase, &program.evaluation};
  for (int i = 0; i < 3; ++i) {
    *segments[i] = allocation.assign(schedule(steps.levels[static_cast<int>(kSegments[i])]));
  }
  program.slot_count = std::max(program.slot_count, allocation.getLargestEnd());
  for (const int node : wanted) {
    program.outputs.push_back(allocation.getSlot(node));
  }
  return program;
}

}  // namespace twinmap::program
