#include "kernels/network/weight_density.hpp"

#include <gtest/gtest.h>

#include "tests/kernels/network/waves.hpp"

namespace twinmap::network {
namespace {

WeightDensity makeDensity() {
  return {makeWaveNetwork(), makeWave(kInputs, kSamples, 30), 0.4 * makeWave(kTargets, kSamples, 31)};
}

TEST(WeightDensity, UnpacksWhatItHasPacked) {
  const WeightDensity density = makeDensity();
  Network network = makeWaveNetwork();
  network.skip.array() += 0.2;
  network.layers[1].biases.array() -= 0.3;
  const Network found = density.unpack(density.pack(network));
  EXPECT_LT((found.skip - network.skip).norm(), 1e-14);
  for (std::size_t i = 0; i < network.layers.size(); ++i) {
    EXPECT_LT((found.layers[i].weights - network.layers[i].weights).norm(), 1e-14);
    EXPECT_LT((found.layers[i].biases - network.layers[i].biases).norm(), 1e-14);
  }
}

TEST(WeightDensity, HasTheGradientOfFiniteDifferences) {
  WeightDensity density = makeDensity();
  const VectorXd z = density.pack(makeWaveNetwork());
  VectorXd gradient, other;
  const double value = density.calculate(z, gradient);
  PassWorkspace pass;
  EXPECT_NEAR(value,
              -calcLoss(makeWaveNetwork(), makeWave(kInputs, kSamples, 30),
                        0.4 * makeWave(kTargets, kSamples, 31), pass) -
                  0.5 * z.squaredNorm(),
              1e-10 * std::abs(value));
  constexpr double kStep = 1e-6;
  for (Index i = 0; i < z.size(); ++i) {
    const VectorXd apart = kStep * VectorXd::Unit(z.size(), i);
    const double slope =
        (density.calculate(z + apart, other) - density.calculate(z - apart, other)) / (2.0 * kStep);
    EXPECT_NEAR(gradient[i], slope, 1e-6 * (1.0 + gradient.norm()));
  }
}

}  // namespace
}  // namespace twinmap::network
