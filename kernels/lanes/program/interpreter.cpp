#include "kernels/lanes/program/interpreter.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace twinmap::program {
std::vector<const Engine*> getEngines() {
  std::vector<const Engine*> engines{&kEngine4, &kEngine8, &kEngine8Of4, &kEngine16, &kEngine16Of4};
  engines.erase(
      std::remove_if(engines.begin(), engines.end(), [](const Engine* e) { return !e->isSupported(); }),
      engines.end());
  return engines;
}

Interpreter::Interpreter(const Program& program, const Engine& engine)
    : engine_(&engine),
      counts_(program.counts),
      time_(program.getTimeSlot()),
      parameter_(place(program.parameter)),
      phase_(place(program.phase)),
      evaluation_(place(program.evaluation)),
      slots_(static_cast<std::size_t>(program.slot_count) * engine.lanes) {
  if (program.slot_count > countReachable(engine)) {
    throw std::length_error("a program needs " + std::to_string(program.slot_count) +
                            " values at a time; with " + std::to_string(engine.lanes) +
                            " lanes it may have " + std::to_string(countReachable(engine)));
  }
  for (const int slot : program.outputs) {
    outputs_.push_back(static_cast<std::size_t>(slot) * engine.lanes);
  }
  for (const Literal& literal : program.literals) {
    std::fill_n(updRow(literal.slot), engine.lanes, literal.value);
  }
}

Interpreter::PlacedSegment Interpreter::place(const Segment& segment) const {
  PlacedSegment placed;
  for (const Run& run : segment.runs) {
    placed.runs.push_back({run.operation, static_cast<std::uint32_t>(run.count)});
  }
  const auto getPlace = [this](int slot) {
    return static_cast<std::uint16_t>(std::max(slot, 0) * engine_->lanes / kPlace);
  };
  for (const Instruction& i : segment.instructions) {
    const int last = i.targets[1] >= 0 ? i.targets[1] : i.operands[2];
    placed.instructions.push_back(
        {getPlace(i.targets[0]), getPlace(i.operands[0]), getPlace(i.operands[1]), getPlace(last)});
  }
  return placed;
}

}  // namespace twinmap::program
