#pragma once

#include <cstdint>

#include "kernels/lanes/program/operation.hpp"

namespace twinmap::program {

/// The unit of places in an array of slots, in doubles: instructions are half as long for it, and stay in the
/// cache.
constexpr int kPlace = 4;

/// An instruction with its slots as places in the array of slots, which depend on the number of lanes.
struct PlacedInstruction {
  std::uint16_t target, a, b, c;  ///< c is also the second target of kSinCos
};

struct PlacedRun {
  Operation operation;
  std::uint32_t count;
};

/// The loops over the instructions of a segment, for one number of lanes and one instruction set. An array of
/// slots begins at a multiple of 64 bytes and holds `lanes` doubles a slot.
struct Engine {
  int lanes;
  bool (*isSupported)();  ///< by this processor
  void (*run)(const PlacedRun* runs, const PlacedRun* end, const PlacedInstruction* instructions,
              double* slots);
};

/// Registers of 4 (AVX2 and fused multiply-add, or none) and 8 doubles (AVX-512). Each does its arithmetic in
/// `lanes` / 4 or / 8 independent chains, which hide each other's latency and share what an instruction and a
/// run cost.
extern const Engine kEngine4, kEngine8, kEngine8Of4, kEngine16, kEngine16Of4;

}  // namespace twinmap::program
