// Compiled for AVX-512 even where the rest is not: nothing here may run before isSupported() said yes.
#include "kernels/lanes/program/instruction_loops.hpp"

namespace twinmap::program {
namespace {

bool isSupported() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}

}  // namespace

const Engine kEngine8{8, isSupported, InstructionLoops<Packet8, 1>::run};
const Engine kEngine16{16, isSupported, InstructionLoops<Packet8, 2>::run};

}  // namespace twinmap::program
