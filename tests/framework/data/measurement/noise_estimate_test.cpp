#include "framework/data/noise/noise_estimate.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/framework/data/measurement/golden/burg_golden.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd simulate(const std::vector<double>& coefficients, Index count, unsigned seed, double stddev = 1.0) {
  constexpr Index kTransient = 500;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, stddev);
  VectorXd x = VectorXd::NullaryExpr(count + kTransient, [&] { return normal(generator); });
  for (Index k = 0; k < x.size(); ++k) {
    for (Index i = 0; i < std::min<Index>(k, static_cast<Index>(coefficients.size())); ++i) {
      x[k] += coefficients[i] * x[k - 1 - i];
    }
  }
  return x.tail(count);
}

TEST(Burg, AgreesWithExactArithmetic) {
  const VectorXd samples = Eigen::Map<const VectorXd>(kBurgSamples, std::size(kBurgSamples));
  const AutoregressiveModel model =
      fitAutoregression(samples, static_cast<int>(std::size(kBurgCoefficients)));
  ASSERT_EQ(model.coefficients.size(), std::size(kBurgCoefficients));
  for (std::size_t i = 0; i < model.coefficients.size(); ++i) {
    EXPECT_NEAR(model.coefficients[i], kBurgCoefficients[i], 1e-14);
  }
  EXPECT_NEAR(model.innovation_stddev * model.innovation_stddev, kBurgVariance, 1e-13);
}

// The asymptotic standard error of the coefficients of an AR(2) is sqrt((1 - a_2^2) / n) = 0.0064 here.
TEST(NoiseEstimate, FindsAnAutoregression) {
  const std::vector<double> truth{1.2, -0.6};
  const NoiseEstimate estimate = estimateNoise(simulate(truth, 16000, 1));
  ASSERT_EQ(estimate.model.coefficients.size(), 2U);
  EXPECT_NEAR(estimate.model.coefficients[0], truth[0], 4 * 0.0064);
  EXPECT_NEAR(estimate.model.coefficients[1], truth[1], 4 * 0.0064);
  EXPECT_NEAR(estimate.model.innovation_stddev, 1.0, 4 * std::sqrt(0.5 / 16000));
  // gamma_0 = (1 - a_2) / ((1 + a_2) ((1 - a_2)^2 - a_1^2))
  const double stddev = std::sqrt(1.6 / (0.4 * (1.6 * 1.6 - 1.2 * 1.2)));
  EXPECT_NEAR(estimate.stddev, stddev, 4 * estimate.stddev_error);
  EXPECT_GT(estimate.whiteness, 1e-3);
}

TEST(NoiseEstimate, WhiteNoiseHasOrderZero) {
  int white = 0, passed = 0;
  constexpr int kSeeds = 200;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NoiseEstimate estimate = estimateNoise(simulate({}, 1000, seed, 0.5));
    white += estimate.model.coefficients.empty() ? 1 : 0;
    passed += estimate.whiteness > 0.05 ? 1 : 0;
  }
  EXPECT_GE(white, 0.9 * kSeeds);
  EXPECT_NEAR(passed, 0.95 * kSeeds, 4 * std::sqrt(0.05 * 0.95 * kSeeds));
}

TEST(NoiseEstimate, TheStandardErrorIsThatOfRepeatedEstimates) {
  for (const std::vector<double>& coefficients : {std::vector<double>{}, std::vector<double>{0.8}}) {
    constexpr int kSeeds = 400;
    double sum = 0.0, squares = 0.0, errors = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const NoiseEstimate estimate = estimateNoise(simulate(coefficients, 1000, seed));
      sum += estimate.stddev;
      squares += estimate.stddev * estimate.stddev;
      errors += estimate.stddev_error;
    }
    const double mean = sum / kSeeds, spread = std::sqrt(squares / kSeeds - mean * mean);
    EXPECT_NEAR(errors / kSeeds / spread, 1.0, 4 / std::sqrt(2.0 * kSeeds));
  }
}

TEST(NoiseEstimate, ALinearDriftIsNoNoise) {
  const VectorXd noise = simulate({}, 2000, 3, 0.01);
  const VectorXd drifting = noise + VectorXd::LinSpaced(2000, 5.0, 9.0);
  EXPECT_NEAR(estimateNoise(drifting).stddev, estimateNoise(noise).stddev, 1e-12);
  EXPECT_NEAR(estimateNoise(drifting).mean, 7.0, 0.01);
}

TEST(NoiseEstimate, AutocorrelationOfAFirstOrderModelIsGeometric) {
  const VectorXd rho = calcAutocorrelation({{0.9}, 1.0}, 10);
  for (Index k = 0; k < rho.size(); ++k) {
    EXPECT_NEAR(rho[k], std::pow(0.9, k), 1e-12);
  }
  EXPECT_EQ(calcAutocorrelation({{}, 1.0}, 3), Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(NoiseEstimate, RefusesWhatHasNoNoise) {
  EXPECT_THROW(estimateNoise(VectorXd::Ones(100)), std::invalid_argument);
  EXPECT_THROW(estimateNoise(VectorXd::LinSpaced(100, 1.0, 2.0)), std::invalid_argument);
  EXPECT_THROW(estimateNoise(simulate({}, 19, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap
