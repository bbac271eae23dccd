// Samples that cannot be integrated, and their neighbours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/kernels/lanes/batch.hpp"

namespace twinmap::lanes {
namespace {

using program::Recorder;
using testing::Batch;
using testing::drawPoints;

/// y' = scale y^p, whose solution reaches infinity at t = 1 for p = 2 and y(0) = 1; with a pivot that
/// vanishes at t = 1 + q.
struct Hazard {
  static Problem makeProblem() {
    Recorder r;
    Equations equations;
    equations.counts = {1, 3, 0};
    equations.derivatives = {r.parameter(2) * pow(r.state(0), r.parameter(0))};
    equations.pivots = {1.0 + r.parameter(1) - r.time()};
    equations.outputs = {r.state(0)};
    return lanes::makeProblem(r, equations);
  }
  static Sample makeSample(double p, double q, double scale, double initial = 1.0) {
    Sample sample;
    sample.parameters = {p, q, scale};
    sample.initial = {initial};
    sample.phases = {{0.0, {}}};
    sample.end = 2.0;
    return sample;
  }
};

TEST(Lanes, AFailureIsNamedAndItsNeighboursKeepTheirBits) {
  const std::vector<double> times{0.5, 1.0, 2.0};
  const double nan = std::nan("");
  const Sample good = Hazard::makeSample(0.0, 99.0, 1.0);
  const std::vector<std::pair<Sample, Outcome>> bad{
      {Hazard::makeSample(2.0, 99.0, 1.0), Outcome::kStepTooSmall},  // y reaches infinity at t = 1
      {Hazard::makeSample(0.0, 0.5, 1.0), Outcome::kSingular},
      {Hazard::makeSample(0.0, 99.0, nan), Outcome::kNonFinite},
      {Hazard::makeSample(0.0, 99.0, INFINITY), Outcome::kNonFinite},
      {Hazard::makeSample(1.0, 99.0, 1.0, nan), Outcome::kNonFinite},
  };
  for (const StepEngine* engine : getEngines()) {
    Integrator integrator(Hazard::makeProblem(), times, {}, *engine);
    Batch alone;
    alone.add(good, 3, 0);
    alone.run(integrator);
    for (const auto& [sample, outcome] : bad) {
      Batch batch;
      for (int i = 0; i < 40; ++i) {
        batch.add(i % 7 == 3 ? sample : good, 3, 0);
      }
      batch.run(integrator);
      for (int i = 0; i < 40; ++i) {
        if (i % 7 == 3) {
          const Outcome found = batch.results[i].outcome;
          const bool blows_up = outcome == Outcome::kStepTooSmall && found == Outcome::kNonFinite;
          EXPECT_TRUE(found == outcome || blows_up)
              << "expected " << static_cast<int>(outcome) << ", found " << static_cast<int>(found)
              << " at t = " << batch.results[i].time;
          EXPECT_EQ(batch.outputs[i * 3], -99.0) << "nothing is written";
        } else {
          EXPECT_EQ(batch.results[i].outcome, Outcome::kDone);
          EXPECT_TRUE(std::equal(alone.outputs.begin(), alone.outputs.end(), batch.outputs.begin() + i * 3));
        }
      }
    }
  }
}

TEST(Lanes, FailuresHaveTheirTime) {
  Integrator integrator(Hazard::makeProblem(), {2.0}, {}, chooseEngine(8));
  Batch batch;
  batch.add(Hazard::makeSample(2.0, 99.0, 1.0), 1, 0);
  batch.add(Hazard::makeSample(0.0, 0.5, 1.0), 1, 0);
  batch.run(integrator);
  EXPECT_NEAR(batch.results[0].time, 1.0, 1e-6);
  EXPECT_LT(batch.results[1].time, 1.5);
  EXPECT_GT(batch.results[1].time, 0.0);
}

TEST(Lanes, StepsAreLimited) {
  Options options;
  options.max_steps = 20;
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), options, chooseEngine(8));
  Batch batch;
  batch.add(two_beam::makeSample(drawPoints(1)[0], 0, nullptr, nullptr), 200, 0);
  batch.run(integrator);
  EXPECT_EQ(batch.results[0].outcome, Outcome::kStepLimit);
  EXPECT_EQ(batch.results[0].steps, 20);
  EXPECT_GT(batch.results[0].time, 0.0);
}

TEST(Lanes, WallTimeIsLimited) {
  Options options;
  options.max_wall_time = 1e-9;
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), options, chooseEngine(8));
  Batch batch;
  batch.add(two_beam::makeSample(drawPoints(1)[0], 0, nullptr, nullptr), 200, 0);
  batch.run(integrator);
  EXPECT_EQ(batch.results[0].outcome, Outcome::kWallTime);
  EXPECT_EQ(batch.results[0].time, 0.0);
}

}  // namespace
}  // namespace twinmap::lanes
