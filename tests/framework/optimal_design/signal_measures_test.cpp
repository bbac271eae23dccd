#include "framework/optimal_design/signal_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap::experiment_design {
namespace {

Expression makeNumber(const std::string& text) {
  return {text, {}};
}

ModelSpec makeModel(SignalSpec signal) {
  ModelSpec model;
  model.simulation.duration = 5.0;
  model.excitation = {std::move(signal)};
  return model;
}

TEST(SignalMeasures, AreThoseOfAPulse) {
  SignalSpec signal;
  signal.name = {"F", {}};
  signal.pulses = {{makeNumber("5"), makeNumber("0.2"), makeNumber("0.25")}};
  const SignalMeasure measure = calcSignalMeasures(makeModel(signal))[0];
  EXPECT_EQ(measure.max_abs, 5.0);
  EXPECT_NEAR(measure.rms, 5.0 * std::sqrt(0.05 / 5.0), 1e-12);
  EXPECT_NEAR(measure.max_rate, 5.0 / (5.0 / 2000.0), 1e-9);  // a jump
}

TEST(SignalMeasures, AreThoseOfTonesWithAnAmplitudeEach) {
  SignalSpec signal;
  signal.name = {"F", {}};
  MultisineSpec tones;
  tones.amplitudes = {makeNumber("3"), makeNumber("4")};
  tones.frequencies = {makeNumber("1"), makeNumber("2")};
  tones.phases = {makeNumber("0"), makeNumber("0")};
  signal.multisines = {tones};
  const SignalMeasure measure = calcSignalMeasures(makeModel(signal))[0];
  EXPECT_NEAR(measure.rms, 5.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(measure.max_rate, 2.0 * 3.141592653589793 * (3.0 + 2.0 * 4.0), 0.05);  // at t = 0
  EXPECT_GT(measure.max_abs, 5.9);
  EXPECT_LT(measure.max_abs, 7.0);
}

}  // namespace
}  // namespace twinmap::experiment_design
