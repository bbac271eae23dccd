// Outputs of the past and states that jump, against closed forms.
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
  options.relative_tolerance = 1e-10;
  options.absolute_tolerance = 1e-12;
  return options;
}

/// y = exp(-p t) and the same a delay q ago, at most that of t = 0.
TEST(Lanes, OutputsOfThePastAreThoseBeforeADelay) {
  Recorder r;
  Equations equations;
  equations.counts = {1, 2, 0};
  equations.derivatives = {-r.parameter(0) * r.state(0)};
  equations.outputs = {r.state(0) + r.time(), r.state(0) + r.time()};
  equations.delays = {r.parameter(1)};
  equations.output_delays = {-1, 0};
  const std::vector<double> times{0.1, 0.5, 1.25, 2.0};
  Integrator integrator(makeProblem(r, equations, {0, 1}), times, makeTight(), chooseEngine(8));
  Batch batch;
  for (int j = 0; j < 11; ++j) {
    Sample sample;
    sample.parameters = {1.0 + 0.1 * j, 0.3 + 0.02 * j};
    sample.initial = {1.0, 0.0, 0.0};
    sample.phases = {{0.0, {}}, {0.7, {}}};
    sample.end = 2.0;
    sample.delays = {sample.parameters[1]};
    batch.add(sample, 8, 2);
  }
  batch.run(integrator);
  for (int j = 0; j < 11; ++j) {
    const double p = 1.0 + 0.1 * j, delay = 0.3 + 0.02 * j;
    for (int i = 0; i < 4; ++i) {
      const double then = std::max(times[i] - delay, 0.0), y = std::exp(-p * then);
      EXPECT_NEAR(batch.outputs[j * 8 + i], std::exp(-p * times[i]) + times[i], 1e-8);
      EXPECT_NEAR(batch.outputs[j * 8 + 4 + i], y + then, 1e-8);
      EXPECT_NEAR(batch.derivatives[j * 16 + 4 + i], -then * y, 1e-7);
      EXPECT_NEAR(batch.derivatives[j * 16 + 8 + i], 0.0, 1e-9);
      EXPECT_NEAR(batch.derivatives[j * 16 + 12 + i], then > 0.0 ? p * y - 1.0 : 0.0, 1e-7);
    }
  }
}

/// y' = p y from 1; at t = q it becomes u y + t, with u = 2; before that y (1 + 0 t) at the time 0.3.
TEST(Lanes, StatesJumpAtTimesThatMove) {
  Recorder r;
  Equations equations;
  equations.counts = {1, 2, 1};
  equations.derivatives = {r.parameter(0) * r.state(0)};
  equations.outputs = {r.state(0)};
  const Symbol u = r.phaseInput(0);
  equations.jumps = {u * r.state(0) + (u - 1.0) * r.time()};
  const std::vector<double> times{0.2, 0.4, 0.9, 2.0};
  for (const StepEngine* engine : getEngines()) {
    Integrator integrator(makeProblem(r, equations, {0, 1}), times, makeTight(), *engine);
    Batch batch;
    for (int j = 0; j < 11; ++j) {
      Sample sample;
      sample.parameters = {0.5 + 0.1 * j, 0.6 + 0.02 * j};
      sample.initial = {1.0, 0.0, 0.0};
      sample.phases = {{0.0, {0.0}}, {0.3, {1.0}, {}, true}, {sample.parameters[1], {2.0}, {0.0, 1.0}, true}};
      sample.end = 2.0;
      batch.add(sample, 4, 2);
    }
    batch.run(integrator);
    for (int j = 0; j < 11; ++j) {
      const double p = 0.5 + 0.1 * j, q = 0.6 + 0.02 * j;
      for (int i = 0; i < 4; ++i) {
        const double t = times[i], before = std::exp(p * q), growth = std::exp(p * (t - q));
        const bool behind = t > q;
        EXPECT_NEAR(batch.outputs[j * 4 + i], behind ? (2.0 * before + q) * growth : std::exp(p * t), 1e-7);
        EXPECT_NEAR(batch.derivatives[j * 8 + i],
                    behind ? (2.0 * q * before + (2.0 * before + q) * (t - q)) * growth : t * std::exp(p * t),
                    1e-6);
        EXPECT_NEAR(batch.derivatives[j * 8 + 4 + i], behind ? (1.0 - p * q) * growth : 0.0, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace twinmap::lanes
