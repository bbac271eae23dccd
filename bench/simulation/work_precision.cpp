#include "bench/simulation/work_precision.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "bench/simulation/compared_case.hpp"
#include "bench/simulation/measure.hpp"
#include "bench/simulation/mujoco_simulation.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::bench {
namespace {

using Eigen::Index;

constexpr int kLanePoints = 1024;    // as many as make what a stage does once negligible, as in a run
constexpr double kSmallest = 1e-10;  // of the errors that are looked at
constexpr int kFinestSteps = 4096;   // of MuJoCo between two output times

void generate(const MultibodySimulator& simulator, const Eigen::MatrixXd& points) {
  GeneratorOptions options;
  options.threads = 1;
  requireSuccess(generateSamples(simulator, points, options).statuses);
}

/// Half a decade from one to the next.
std::vector<WorkPrecision> measureLanesCurve(const ComparedCase& compared, int rounds) {
  constexpr double kLoosest = 3e-2, kTightest = 1e-12;
  std::vector<WorkPrecision> curve;
  for (double tolerance = kLoosest; tolerance > kTightest; tolerance /= std::sqrt(10.0)) {
    MultibodySimulator simulator(withTolerance(compared.getExperiment().model, tolerance),
                                 compared.getTimes());
    const double error =
        compared.calcError([&](Index i) { return simulateAll(simulator, compared.getPoints().col(i)); });
    const Side side{kLanePoints, [&] { generate(simulator, compared.getPoints()); }};
    curve.push_back({tolerance, error, measureInAlternation({side}, rounds, readThreadTime).front()});
  }
  return curve;
}

/// Steps of whole numbers in an interval of times, some 1.3 times as many from one to the next.
std::vector<WorkPrecision> measureMujocoCurve(const ComparedCase& compared, int rounds) {
  constexpr Index kSamples = 4;
  constexpr double kMore = 1.3;
  MujocoSimulation mujoco(compared.getMechanism(), compared.calcStart(), compared.getTimes());
  std::vector<WorkPrecision> curve;
  for (int steps = 1; curve.empty() || curve.back().error > kSmallest;
       steps = std::max(steps + 1, static_cast<int>(kMore * steps))) {
    if (steps > kFinestSteps) {
      throw std::runtime_error(fmt::format("{}: MuJoCo simulates another mechanism: its error stays {:.1e}",
                                           compared.getMechanism().name, curve.back().error));
    }
    const auto run = [&](Index i) { return mujoco.simulate(compared.getPoints().col(i), steps); };
    const double error = compared.calcError(run);
    if (!std::isfinite(error)) {
      continue;
    }
    const Side side{kSamples, [&] {
                      for (Index i = 0; i < kSamples; ++i) {
                        run(i);
                      }
                    }};
    curve.push_back(
        {mujoco.getInterval() / steps, error, measureInAlternation({side}, rounds, readThreadTime).front()});
  }
  return curve;
}

}  // namespace

WorkPrecisionCurves measureCurves(const Mechanism& mechanism, int rounds) {
  const ComparedCase compared(mechanism, kLanePoints);
  return {mechanism.name, measureLanesCurve(compared, rounds), measureMujocoCurve(compared, rounds)};
}

}  // namespace twinmap::bench
