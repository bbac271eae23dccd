#include <unistd.h>

#include <cstring>

// A program for x86-64-v3 would die of an illegal instruction on an older processor, and say nothing; so
// would one that loads such a library, before it could ask. This unit is compiled for every x86-64, and runs
// before all others of the program or library that it is part of.
namespace {

[[gnu::constructor(101)]] void requireProcessor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
    return;
  }
  constexpr char kMessage[] =
      "twinmap: error: this processor lacks AVX2, FMA or BMI2 (x86-64-v3), which twinmap needs\n";
  (void)!::write(STDERR_FILENO, kMessage, std::strlen(kMessage));
  ::_exit(1);
}

}  // namespace
