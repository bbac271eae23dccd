#include <algorithm>

#include "kernels/lanes/program/engine.hpp"

namespace twinmap::program {

double evaluate(Operation operation, double a, double b, double c) {
  alignas(64) double slots[4][4];
  std::fill_n(slots[0], 4, a);
  std::fill_n(slots[1], 4, b);
  std::fill_n(slots[2], 4, c);
  const PlacedRun run{operation, 1};
  const PlacedInstruction instruction{3, 0, 1, 2};
  kEngine4.run(&run, &run + 1, &instruction, slots[0]);
  return slots[3][0];
}

}  // namespace twinmap::program
