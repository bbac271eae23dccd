// Simulation in lanes against MuJoCo's Runge-Kutta method at equal error, and against Simbody; one thread,
// processor time. Then what a second thread brings, on the wall. See bench/README.md.
// Usage: mujoco_benchmark [rounds]

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "bench/simulation/compared_case.hpp"
#include "bench/simulation/measure.hpp"
#include "bench/simulation/report.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::bench {
namespace {

constexpr int kThreadPoints = 8192;  // some 0.4 s on one thread, long beside starting a thread
constexpr int kBatchPoints = 128;    // MultibodySimulator's batches

void compareThreads(const Mechanism& mechanism, int rounds) {
  const ExperimentSpec experiment = loadMechanism(mechanism, kThreadPoints);
  const MultibodySimulator simulator(experiment.model, collectTimes(experiment.features));
  const Eigen::MatrixXd points = sampleTestPoints(experiment);
  const auto run = [&](int threads) {
    GeneratorOptions options;
    options.threads = threads;
    return Side{kThreadPoints,
                [&simulator, &points, options] { generateSamples(simulator, points, options); }};
  };
  const std::vector<double> times = measureInAlternation({run(1), run(2)}, rounds, readWallTime);
  fmt::print("\n{}, {} samples, on the wall: {:.1f} us a sample on one thread, {:.1f} on two: {:.2f} times\n",
             mechanism.name, kThreadPoints, times[0], times[1], times[0] / times[1]);
}

void run(int rounds) {
  fmt::print("MuJoCo {}; medians of {} rounds in alternation\n\n", mj_versionString(), rounds);
  const std::vector<Mechanism> mechanisms = makeMechanisms();
  std::vector<Comparison> comparisons;
  for (const Mechanism& mechanism : mechanisms) {
    comparisons.push_back(compare(mechanism, rounds));
  }
  printComparisons(comparisons);
  printLanes(comparisons);
  printPrograms(comparisons, measureMultiplyAdds(kBatchPoints), measureSines(kBatchPoints));
  compareThreads(mechanisms.front(), rounds);
}

}  // namespace
}  // namespace twinmap::bench

int main(int count, char** arguments) {
  constexpr int kMinRounds = 5;
  try {
    twinmap::bench::run(std::max(kMinRounds, count > 1 ? std::atoi(arguments[1]) : 7));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
