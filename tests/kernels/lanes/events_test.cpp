// Events whose time depends on the solution, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/lanes/program/recorder.hpp"
#include "tests/kernels/lanes/batch.hpp"

namespace twinmap::lanes {
namespace {

using program::Recorder;
using program::Symbol;
using testing::Batch;

Options makeTight() {
  Options options;
  options.relative_tolerance = 1e-11;
  options.absolute_tolerance = 1e-13;
  return options;
}

/// y' = -p y from 1; where it falls to q it becomes y + 1, again and again. The second state counts.
Equations makeFalling(Recorder& r) {
  Equations equations;
  equations.counts = {2, 2, 1};
  equations.derivatives = {-r.parameter(0) * r.state(0), 0.0};
  equations.outputs = {r.state(0), r.state(1)};
  equations.guards = {r.state(0) - r.parameter(1)};
  const Symbol happens = less(Symbol(0.0), r.phaseInput(0));
  equations.transitions = {select(happens, r.state(0) + 1.0, r.state(0)),
                           select(happens, r.state(1) + 1.0, r.state(1))};
  equations.event_input = 0;
  return equations;
}

Sample makeSample(double p, double q, int directions) {
  Sample sample;
  sample.parameters = {p, q};
  sample.initial.assign(2 * (1 + directions), 0.0);
  sample.initial[0] = 1.0;
  sample.phases = {{0.0, {0.0}}, {0.37, {0.0}}};
  sample.end = 3.0;
  return sample;
}

/// The value behind n jumps: q = exp(-p t1), q = (1 + q) exp(-p (t2 - t1)) ...
double calcFalling(double p, double q, double t) {
  double begin = 0.0, value = 1.0;
  for (;;) {
    const double end = begin + std::log(value / q) / p;
    if (t < end) {
      return value * std::exp(-p * (t - begin));
    }
    begin = end;
    value = q + 1.0;
  }
}

const std::vector<double> kTimes{0.2, 0.9, 1.6, 2.3, 2.9};

TEST(Events, AreFoundWhereTheyAreWithTheirDerivatives) {
  for (const StepEngine* engine : getEngines()) {
    Recorder r;
    Integrator integrator(makeProblem(r, makeFalling(r), {0, 1}), kTimes, makeTight(), *engine);
    Batch batch;
    for (int j = 0; j < 11; ++j) {
      batch.add(makeSample(1.0 + 0.1 * j, 0.5 + 0.01 * j, 2), 10, 2);
    }
    batch.run(integrator);
    for (int j = 0; j < 11; ++j) {
      const double p = 1.0 + 0.1 * j, q = 0.5 + 0.01 * j, step = 1e-5;
      ASSERT_EQ(batch.results[j].outcome, Outcome::kDone);
      for (int i = 0; i < 5; ++i) {
        const double t = kTimes[i];
        EXPECT_NEAR(batch.outputs[j * 10 + i], calcFalling(p, q, t), 1e-8);
        EXPECT_NEAR(batch.derivatives[j * 20 + i],
                    (calcFalling(p + step, q, t) - calcFalling(p - step, q, t)) / (2.0 * step), 1e-6);
        EXPECT_NEAR(batch.derivatives[j * 20 + 10 + i],
                    (calcFalling(p, q + step, t) - calcFalling(p, q - step, t)) / (2.0 * step), 1e-6);
      }
      EXPECT_EQ(batch.outputs[j * 10 + 9],
                std::floor(1.0 + (p * 2.9 + std::log(q)) / std::log((1.0 + q) / q)));
    }
  }
}

TEST(Events, DoNotDependOnTheOtherLanes) {
  Batch alone, together;
  Recorder r;
  const Problem problem = makeProblem(r, makeFalling(r), {0, 1});
  for (int j = 0; j < 37; ++j) {
    const Sample sample = makeSample(1.0 + 0.03 * j, 0.4 + 0.01 * j, 2);
    together.add(sample, 10, 2);
    if (j == 20) {
      alone.add(sample, 10, 2);
    }
  }
  Integrator single(problem, kTimes, {}, kSteps4);
  alone.run(single);
  for (const StepEngine* engine : getEngines()) {
    Integrator integrator(problem, kTimes, {}, *engine);
    together.run(integrator);
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(together.outputs[200 + i], alone.outputs[i]);
    }
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(together.derivatives[400 + i], alone.derivatives[i]);
    }
    EXPECT_EQ(together.results[20].steps, alone.results[0].steps);
    EXPECT_EQ(together.results[20].events, alone.results[0].events);
  }
}

/// Where a phase makes a guard negative the event is due at its begin, and moves with that. The second state
/// says that it has been.
TEST(Events, AreDueWhereAPhaseBeginsThatMakesThem) {
  Recorder r;
  Equations equations;
  equations.counts = {2, 1, 2};
  equations.derivatives = {r.parameter(0), 0.0};
  equations.outputs = {r.state(0)};
  equations.guards = {select(less(Symbol(0.5), r.state(1)), Symbol(1.0), 0.5 - r.phaseInput(1))};
  const Symbol happens = less(Symbol(0.0), r.phaseInput(0));
  equations.transitions = {select(happens, 2.0 * r.state(0), r.state(0)), happens};
  equations.event_input = 0;
  Integrator integrator(makeProblem(r, equations, {0}), {0.5, 1.5}, makeTight(), kSteps4);
  Batch batch;
  Sample sample;
  const double p = 1.3;
  sample.parameters = {p};
  sample.initial = {0.2, 0.0, 0.0, 0.0};
  sample.phases = {{0.0, {0.0, 0.0}}, {p / 2.0, {0.0, 1.0}, {0.5}}, {1.0, {0.0, 0.0}}};  // begins at p / 2
  sample.end = 1.5;
  batch.add(sample, 2, 1);
  batch.run(integrator);
  ASSERT_EQ(batch.results[0].outcome, Outcome::kDone);
  EXPECT_EQ(batch.results[0].events, 1);
  EXPECT_NEAR(batch.outputs[0], 0.2 + p * 0.5, 1e-10);
  EXPECT_NEAR(batch.outputs[1], 2.0 * (0.2 + p * p / 2.0) + p * (1.5 - p / 2.0), 1e-10);
  EXPECT_NEAR(batch.derivatives[1], 2.0 * p + 1.5 - p, 1e-9);
}

/// y'' = 1 from p at the speed -1, which the method solves in one step however long: y is below 0 for a while
/// of it. There the speed becomes 1.
TEST(Events, AreFoundWhereAGuardDipsBetweenTwoLooks) {
  Recorder r;
  Equations equations;
  equations.counts = {2, 1, 1};
  equations.derivatives = {r.state(1), 1.0};
  equations.outputs = {r.state(0)};
  equations.guards = equations.dips = {r.state(0)};
  equations.transitions = {r.state(0), select(less(Symbol(0.0), r.phaseInput(0)), Symbol(1.0), r.state(1))};
  equations.event_input = 0;
  Integrator integrator(makeProblem(r, equations, {0}), {20.0}, {}, kSteps4);
  Batch batch;
  const double starts[] = {0.3, 0.45, 0.4999};
  for (const double p : starts) {
    Sample sample;
    sample.parameters = {p};
    sample.initial = {p, -1.0, 1.0, 0.0};
    sample.phases = {{0.0, {0.0}}};
    sample.end = 20.0;
    batch.add(sample, 1, 1);
  }
  batch.run(integrator);
  for (int j = 0; j < 3; ++j) {
    ASSERT_EQ(batch.results[j].outcome, Outcome::kDone);
    EXPECT_EQ(batch.results[j].events, 1);
    const double root = std::sqrt(1.0 - 2.0 * starts[j]), since = 19.0 + root;
    EXPECT_NEAR(batch.outputs[j], since + 0.5 * since * since, 1e-6);
    EXPECT_NEAR(batch.derivatives[j], -(1.0 + since) / root, 1e-4 / root);
  }
}

/// A guard that its own event leaves at 0.
TEST(Events, WithoutProgressFailWithTheirTime) {
  Recorder r;
  Equations equations;
  equations.counts = {1, 0, 1};
  equations.derivatives = {1.0};
  equations.outputs = {r.state(0)};
  equations.guards = {1.0 - r.state(0)};
  const Symbol event = r.phaseInput(0);
  equations.transitions = {select(less(Symbol(0.0), event), r.state(0) - 1e-18, r.state(0))};
  equations.event_input = 0;
  Integrator integrator(makeProblem(r, equations), {2.0}, makeTight(), kSteps4);
  Batch batch;
  Sample sample;
  sample.initial = {0.0};
  sample.phases = {{0.0, {0.0}}};
  sample.end = 2.0;
  batch.add(sample, 1, 0);
  batch.run(integrator);
  EXPECT_EQ(batch.results[0].outcome, Outcome::kEventsStuck);
  EXPECT_NEAR(batch.results[0].time, 1.0, 1e-12);
}

}  // namespace
}  // namespace twinmap::lanes
