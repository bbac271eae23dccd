// Work against precision, in lanes and by MuJoCo's Runge-Kutta method: a row of CSV for each setting of both.
// One thread, processor time. bench/simulation/work_precision.py builds it, runs it and makes tables of its
// rows. Usage: work_precision_benchmark [rounds]

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bench/simulation/mechanism.hpp"
#include "bench/simulation/work_precision.hpp"

namespace twinmap::bench {
namespace {

void print(const std::string& mechanism, const std::string& method, const std::vector<WorkPrecision>& curve) {
  for (const WorkPrecision& point : curve) {
    fmt::print("{},{},{:.4g},{:.3e},{:.2f}\n", mechanism, method, point.setting, point.error, point.time);
  }
}

void run(int rounds) {
  fmt::print("mechanism,method,setting,error,us\n");
  for (const Mechanism& mechanism : makeCurveMechanisms()) {
    const WorkPrecisionCurves curves = measureCurves(mechanism, rounds);
    print(curves.mechanism, "twinmap", curves.lanes);
    print(curves.mechanism, std::string("MuJoCo ") + mj_versionString(), curves.mujoco);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace twinmap::bench

int main(int count, char** arguments) {
  constexpr int kMinRounds = 1, kRounds = 5;
  try {
    twinmap::bench::run(std::max(kMinRounds, count > 1 ? std::atoi(arguments[1]) : kRounds));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
