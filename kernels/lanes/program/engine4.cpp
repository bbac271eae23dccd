#include "kernels/lanes/program/instruction_loops.hpp"

namespace twinmap::program {
namespace {

bool isSupported() {
  return true;
}

}  // namespace

const Engine kEngine4{4, isSupported, InstructionLoops<Packet4, 1>::run};
const Engine kEngine8Of4{8, isSupported, InstructionLoops<Packet4, 2>::run};
const Engine kEngine16Of4{16, isSupported, InstructionLoops<Packet4, 4>::run};

}  // namespace twinmap::program
