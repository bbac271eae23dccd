// Solutions and sensitivities against closed forms and tight integrations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/lanes/program/interpreter.hpp"
#include "tests/kernels/lanes/batch.hpp"
#include "tests/kernels/lanes/oracle.hpp"
#include "tests/kernels/lanes/pendulum.hpp"

namespace twinmap::lanes {
namespace {

using program::Recorder;
using program::Symbol;
using testing::Batch;
using testing::drawPoints;
using testing::integrateTightly;
using testing::makeTwoBeamOptions;
using testing::State;

std::vector<State> solveTwoBeam(const std::vector<double>& point) {
  const auto f = [&point](double t, const State& x) {
    const bool on = t > two_beam::kPulseBegin && t < two_beam::kPulseEnd;
    return two_beam::calcDerivatives<double>(x, point, on ? 1.0 : 0.0);
  };
  return integrateTightly(f, {0.0, two_beam::calcEquilibrium(), 0.0, 0.0}, 0.0, two_beam::makeTimes(),
                          {two_beam::kPulseBegin, two_beam::kPulseEnd});
}

double calcRange(const double* values, int count) {
  const auto [low, high] = std::minmax_element(values, values + count);
  return *high - *low;
}

TEST(Lanes, TwoBeamsAreThoseOfATightIntegration) {
  Batch batch;
  const auto points = drawPoints(20);
  for (const auto& point : points) {
    batch.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
  }
  Integrator integrator(two_beam::makeProblem(), two_beam::makeTimes(), {}, chooseEngine(8));
  batch.run(integrator);
  double largest = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    EXPECT_EQ(batch.results[j].outcome, Outcome::kDone);
    const std::vector<State> expected = solveTwoBeam(points[j]);
    for (int output = 0; output < 2; ++output) {
      const double* const values = &batch.outputs[j * 200 + output * 100];
      for (int i = 0; i < 100; ++i) {
        largest = std::max(largest, std::abs(values[i] - expected[i][output]) / calcRange(values, 100));
      }
    }
  }
  EXPECT_LT(largest, 1.3e-6);  // what the prototype was measured at
  EXPECT_LT(integrator.getStatistics().rejected, 0.02 * integrator.getStatistics().steps);
}

/// Central differences of order 4 of the tight integration; 1e-3 of the box, error about 1e-9 of the range.
TEST(Lanes, SensitivitiesAreTheLimitOfDifferences) {
  const std::vector<int> directions{0, 1, 2, 3};
  Batch batch;
  const auto points = drawPoints(3);
  for (const auto& point : points) {
    batch.add(two_beam::makeSample(point, 4, nullptr, nullptr), 200, 4);
  }
  Integrator integrator(two_beam::makeProblem(directions), two_beam::makeTimes(), makeTwoBeamOptions(4),
                        chooseEngine(8));
  batch.run(integrator);
  double largest = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    for (int direction = 0; direction < 4; ++direction) {
      const double h = 1e-3 * (two_beam::kUpper[direction] - two_beam::kLower[direction]);
      const auto solveAt = [&](double offset) {
        std::vector<double> point = points[j];
        point[direction] += offset;
        return solveTwoBeam(point);
      };
      const auto a = solveAt(-2 * h), b = solveAt(-h), c = solveAt(h), d = solveAt(2 * h);
      for (int output = 0; output < 2; ++output) {
        const double* const values = &batch.derivatives[((j * 4 + direction) * 2 + output) * 100];
        for (int i = 0; i < 100; ++i) {
          const double expected =
              (8.0 * (c[i][output] - b[i][output]) - (d[i][output] - a[i][output])) / (12.0 * h);
          largest = std::max(largest, std::abs(values[i] - expected) / calcRange(values, 100));
        }
      }
    }
  }
  EXPECT_LT(largest, 1e-4);
}

TEST(Lanes, ValuesWithSensitivitiesAreAsGoodAsThoseAlone) {
  Batch alone, with;
  for (const auto& point : drawPoints(8)) {
    alone.add(two_beam::makeSample(point, 0, nullptr, nullptr), 200, 0);
    with.add(two_beam::makeSample(point, 4, nullptr, nullptr), 200, 4);
  }
  Integrator of_values(two_beam::makeProblem(), two_beam::makeTimes(), {}, chooseEngine(8));
  Integrator of_both(two_beam::makeProblem({0, 1, 2, 3}), two_beam::makeTimes(), makeTwoBeamOptions(4),
                     chooseEngine(8));
  alone.run(of_values);
  with.run(of_both);
  for (std::size_t i = 0; i < alone.outputs.size(); i += 100) {
    const double range = calcRange(&alone.outputs[i], 100);
    for (std::size_t k = i; k < i + 100; ++k) {
      EXPECT_NEAR(alone.outputs[k], with.outputs[k], 3e-6 * range);
    }
  }
}

TEST(Lanes, EnergyOfAChainStays) {
  const int masses = 6;
  std::vector<double> times;
  for (int i = 0; i <= 50; ++i) {
    times.push_back(0.1 * i);
  }
  Integrator integrator(pendulum::makeProblem(masses), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 11; ++j) {
    Sample sample;
    sample.parameters = {1.0 + 0.1 * j, 0.5, 9.81};
    sample.initial.assign(2 * masses, 0.0);
    for (int i = 0; i < masses; ++i) {
      sample.initial[i] = 0.1 * j + 0.1 * i;
    }
    sample.phases = {{0.0, {}}};
    sample.end = 5.0;
    batch.add(sample, (masses + 1) * 51, 0);
  }
  batch.run(integrator);
  for (std::size_t j = 0; j < batch.samples.size(); ++j) {
    ASSERT_EQ(batch.results[j].outcome, Outcome::kDone);
    const double* const energy = &batch.outputs[(j * (masses + 1) + masses) * 51];
    for (int i = 0; i < 51; ++i) {
      EXPECT_NEAR(energy[i], energy[0], 1e-4 * std::abs(energy[0]));
    }
  }
}

/// y'' = -w^2 y + gate * t, all of it known: y = A cos(wt) + B sin(wt) + gate t / w^2. The gate opens when
/// the clock reaches `when`, a parameter.
struct Gate {
  static Problem makeProblem(const std::vector<int>& directions) {
    Recorder r;
    Equations equations;
    equations.counts = {2, 2, 1};  // parameters w and when
    const Symbol w = r.parameter(0);
    equations.derivatives = {r.state(1), r.phaseInput(0) * (r.time() + 1.0) - w * w * r.state(0)};
    equations.outputs = {r.state(0), r.state(1) * r.phaseInput(0), equations.derivatives[1]};
    return lanes::makeProblem(r, equations, directions);
  }
  /// With sensitivities, or values alone.
  static Sample makeSample(double w, double when, bool moves) {
    Sample sample;
    sample.parameters = {w, when};
    sample.initial.assign(moves ? 6 : 2, 0.0);
    sample.initial[0] = 1.0;
    sample.phases = {{0.0, {0.0}},
                     {when, {1.0}, moves ? std::vector<double>{0.0, 1.0} : std::vector<double>{}}};
    sample.end = 3.0;
    return sample;
  }
  /// y, y' at t.
  static std::pair<double, double> solve(double w, double when, double t) {
    if (t < when) {
      return {std::cos(w * t), -w * std::sin(w * t)};
    }
    const double y = std::cos(w * when) - (when + 1.0) / (w * w), v = -w * std::sin(w * when) - 1.0 / (w * w);
    const double c = std::cos(w * (t - when)), s = std::sin(w * (t - when));
    return {y * c + v / w * s + (t + 1.0) / (w * w), -y * w * s + v * c + 1.0 / (w * w)};
  }
};

TEST(Lanes, SolutionAndOutputsFollowThePhases) {
  const std::vector<double> times{0.0, 0.4, 1.25, 1.5, 3.0};
  Integrator integrator(Gate::makeProblem({}), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 9; ++j) {
    batch.add(Gate::makeSample(3.0 + j, 1.25, false), 15, 0);
  }
  batch.run(integrator);
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 5; ++i) {
      const double w = 3.0 + j, t = times[i];
      const auto [y, v] = Gate::solve(w, 1.25, t);
      const double on = t >= 1.25 ? 1.0 : 0.0;  // at the event the phase is the one that begins
      EXPECT_NEAR(batch.outputs[j * 15 + i], y, 1e-5);
      EXPECT_NEAR(batch.outputs[j * 15 + 5 + i], on * v, 1e-4);
      EXPECT_NEAR(batch.outputs[j * 15 + 10 + i], on * (t + 1.0) - w * w * y, 2e-5 * w * w);
    }
  }
}

TEST(Lanes, SensitivitiesJumpWhereAnEventMoves) {
  const std::vector<double> times{0.5, 1.2, 1.9, 3.0};
  Integrator integrator(Gate::makeProblem({0, 1}), times, {}, chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 5; ++j) {
    batch.add(Gate::makeSample(2.0 + j, 1.0 + 0.03 * j, true), 12, 2);
  }
  batch.run(integrator);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double w = 2.0 + j, when = 1.0 + 0.03 * j, h = 1e-5;
      const double by_w =
          (Gate::solve(w + h, when, times[i]).first - Gate::solve(w - h, when, times[i]).first) / (2 * h);
      const double by_when =
          (Gate::solve(w, when + h, times[i]).first - Gate::solve(w, when - h, times[i]).first) / (2 * h);
      EXPECT_NEAR(batch.derivatives[(j * 2 + 0) * 12 + i], by_w, 1e-4);
      EXPECT_NEAR(batch.derivatives[(j * 2 + 1) * 12 + i], by_when, 1e-4);
    }
  }
}

TEST(Lanes, SystemAtRestAndAnIntegratorUsedTwice) {
  Recorder r;
  Equations equations;
  equations.counts = {1, 0, 0};
  equations.derivatives = {-r.state(0)};
  equations.outputs = {r.state(0), 5.0};
  Integrator integrator(makeProblem(r, equations), {0.0, 1.0}, {}, chooseEngine(8));
  for (const double initial : {0.0, 2.0}) {
    Sample sample;
    sample.initial = {initial};
    sample.phases = {{0.0, {}}};
    sample.end = 1.0;
    Batch batch;
    batch.add(sample, 4, 0);
    batch.run(integrator);
    EXPECT_EQ(batch.outputs[0], initial);
    EXPECT_NEAR(batch.outputs[1], initial * std::exp(-1.0), 1e-6);
    EXPECT_EQ(batch.outputs[3], 5.0);
  }
  EXPECT_EQ(integrate(integrator, {}).size(), 0u);
}

/// y' = -K y and z' = y of 40 rates with weights 1 ... 40, K their sum: far more directions than states.
TEST(Lanes, SensitivitiesOfManyParametersAreThoseOfTheClosedForm) {
  constexpr int kRates = 40;
  Recorder r;
  Symbol sum = 0.0;
  for (int j = 0; j < kRates; ++j) {
    sum += (1.0 + j) * r.parameter(j);
  }
  Equations equations;
  equations.counts = {2, kRates, 0};
  equations.derivatives = {-sum * r.state(0), r.state(0)};
  equations.outputs = {r.state(1) * r.state(1)};
  std::vector<int> directions(kRates);
  std::iota(directions.begin(), directions.end(), 0);
  const std::vector<double> times{0.5, 1.0, 2.0};
  Integrator integrator(makeProblem(r, equations, directions), times, {}, chooseEngine(8));
  const double rate = 1.2 / (kRates * (kRates + 1) / 2.0), total = 1.2;
  Sample sample;
  sample.parameters.assign(kRates, rate);
  sample.initial.assign(2 * (1 + kRates), 0.0);
  sample.initial[0] = 1.0;
  sample.phases = {{0.0, {}}};
  sample.end = 2.0;
  Batch batch;
  batch.add(sample, 3, kRates);
  batch.run(integrator);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i], left = std::exp(-total * t), z = (1.0 - left) / total;
    const double slope = (t * left - z) / total;  // dz / dK
    EXPECT_NEAR(batch.outputs[i], z * z, 1e-6);
    for (int j = 0; j < kRates; ++j) {
      const double expected = 2.0 * z * slope * (1.0 + j);
      EXPECT_NEAR(batch.derivatives[3 * static_cast<std::size_t>(j) + i], expected, 1e-5 * kRates);
    }
  }
}

/// z' = y after y' = -y: the rate is a state that stands before it.
TEST(Lanes, RatesMayBeEarlierStates) {
  Recorder r;
  Equations equations;
  equations.counts = {2, 0, 0};
  equations.derivatives = {-r.state(0), r.state(0)};
  equations.outputs = {r.state(1)};
  Integrator integrator(makeProblem(r, equations), {1.0, 2.0}, {}, chooseEngine(8));
  Sample sample;
  sample.initial = {1.0, 0.0};
  sample.phases = {{0.0, {}}};
  sample.end = 2.0;
  Batch batch;
  batch.add(sample, 2, 0);
  batch.run(integrator);
  EXPECT_NEAR(batch.outputs[0], 1.0 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(batch.outputs[1], 1.0 - std::exp(-2.0), 1e-6);
}

TEST(Lanes, LargeProblemsHaveFewerLanes) {
  Problem problem;
  problem.counts.states = 2;
  for (const int slots : {1000, 10000, 20000, 40000}) {
    problem.derivative.slot_count = slots;
    for (const int samples : {1, 6, 12, 100}) {
      const program::Engine& engine = chooseEngine(samples, problem).program;
      EXPECT_LE(slots, program::Interpreter::countReachable(engine));
      EXPECT_LE(engine.lanes, chooseEngine(samples).program.lanes);
    }
  }
  problem.derivative.slot_count = 100;
  EXPECT_EQ(&chooseEngine(100, problem), &chooseEngine(100));
  problem.counts.states = 0;  // a sample has as many times as wanted side by side
  EXPECT_EQ(&chooseEngine(1, problem), &chooseEngine(100));
}

/// A point on a circle, whose radius the steps would leave.
TEST(Lanes, ProjectionKeepsWhatSolutionsSatisfyWithItsDerivatives) {
  Recorder r;
  const Symbol x = r.state(0), y = r.state(1), speed = r.parameter(0), radius = r.parameter(1);
  const Symbol length = sqrt(x * x + y * y);
  Equations equations;
  equations.counts = {2, 2, 0};
  equations.derivatives = {-speed * y, speed * x};
  equations.outputs = {length};
  Options options;
  options.relative_tolerance = options.absolute_tolerance = 1e-3;
  double drift[2] = {};
  for (const bool projected : {false, true}) {
    if (projected) {
      equations.projection = {radius * x / length, radius * y / length};
    }
    const Problem problem = makeProblem(r, equations, {0, 1});
    std::vector<double> first;
    for (const StepEngine* engine : getEngines()) {
      Integrator integrator(problem, {20.0}, options, *engine);
      Batch batch;
      for (int j = 0; j < 9; ++j) {
        Sample sample;
        sample.parameters = {1.0 + 0.1 * j, 0.5 + j};
        sample.initial = {0.5 + j, 0.0, 0.0, 0.0, 1.0, 0.0};
        sample.phases = {{0.0, {}}};
        sample.end = 20.0;
        batch.add(sample, 1, 2);
      }
      batch.run(integrator);
      for (int j = 0; j < 9; ++j) {
        drift[projected] = std::max({drift[projected], std::abs(batch.outputs[j] / (0.5 + j) - 1.0),
                                     std::abs(batch.derivatives[2 * j]) / (0.5 + j),
                                     std::abs(batch.derivatives[2 * j + 1] - 1.0)});
      }
      first = first.empty() ? batch.outputs : first;
      EXPECT_EQ(batch.outputs, first);
    }
  }
  EXPECT_GT(drift[0], 1e-4);
  EXPECT_LT(drift[1], 1e-13);
}

}  // namespace
}  // namespace twinmap::lanes
