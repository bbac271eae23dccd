#include "framework/study/replay/residual_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kTimes = 800;
constexpr double kStep = 0.01;  // s

VectorXd makeTimes() {
  return VectorXd::LinSpaced(kTimes, 0.0, kStep * (kTimes - 1));
}

// A sine of amplitude a has n a^2 / 4 at its frequency.
TEST(ResidualSpectrum, HasThePowerOfASineAtItsFrequency) {
  constexpr double kFrequency = 7.5, kAmplitude = 0.6;
  const VectorXd residual = kAmplitude * (2.0 * M_PI * kFrequency * makeTimes().array()).sin();
  const ResidualSpectrum spectrum = calcResidualSpectrum(makeTimes(), residual);
  Index largest = 0;
  const double power = spectrum.power.maxCoeff(&largest);
  EXPECT_NEAR(spectrum.frequency[largest], kFrequency, 0.5 / kStep / 400);
  EXPECT_NEAR(power, kTimes * kAmplitude * kAmplitude / 4.0, 0.02 * kTimes * kAmplitude * kAmplitude / 4.0);
  EXPECT_DOUBLE_EQ(spectrum.frequency[spectrum.frequency.size() - 1], 0.5 / kStep);
}

// Parseval: over the n / 2 equidistant frequencies up to half of the rate the power adds up to half of the
// sum of squares, and half of that of the highest.
TEST(ResidualSpectrum, OfWhiteNoiseIsOneOnAverage) {
  VectorXd residual(kTimes);
  unsigned state = 1;
  for (double& value : residual) {
    state = 1664525U * state + 1013904223U;
    value = (state / 4294967296.0 - 0.5) * std::sqrt(12.0);  // uniform, of variance 1
  }
  residual.array() -= residual.mean();
  const ResidualSpectrum spectrum = calcResidualSpectrum(makeTimes(), residual);
  const double last = spectrum.power[spectrum.power.size() - 1];
  EXPECT_NEAR(spectrum.power.sum(), 0.5 * residual.squaredNorm() + 0.5 * last, 1e-6 * residual.squaredNorm());
}

}  // namespace
}  // namespace twinmap
