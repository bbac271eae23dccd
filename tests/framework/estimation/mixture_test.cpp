#include "framework/estimation/mixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/estimation/draws.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kNormal50 = 0.6744897501960817, kNormal95 = 1.959963984540054;

MarginalMixture makeNormal(double mean, double stddev) {
  return {ArrayXd::Ones(1), ArrayXd::Constant(1, mean), ArrayXd::Constant(1, stddev)};
}

/// Two answers, one of them three times as likely and twice as wide.
MarginalMixture makeTwo() {
  MarginalMixture marginal{ArrayXd(2), ArrayXd(2), ArrayXd(2)};
  marginal.weights << 0.25, 0.75;
  marginal.means << -4.0, 3.0;
  marginal.stddevs << 0.5, 1.0;
  return marginal;
}

/// The trapezoidal rule, whose error is that of rounding for densities that end within the interval.
template <class Function>
double integrate(double lower, double upper, const Function& function) {
  constexpr int kSteps = 40000;
  const double step = (upper - lower) / kSteps;
  double sum = 0.5 * (function(lower) + function(upper));
  for (int i = 1; i < kSteps; ++i) {
    sum += function(lower + i * step);
  }
  return sum * step;
}

TEST(MarginalMixture, OfOneComponentIsTheNormalDistribution) {
  const MarginalMixture normal = makeNormal(2.0, 3.0);
  EXPECT_NEAR(normal.calcDensity(2.0), 1.0 / (3.0 * std::sqrt(2.0 * M_PI)), 1e-15);
  EXPECT_NEAR(normal.calcProbability(2.0 + 3.0 * kNormal95), 0.975, 1e-14);
  const Intervals half = findHighestDensity(normal, 0.5);
  ASSERT_EQ(half.size(), 1U);
  EXPECT_NEAR(half[0].first, 2.0 - 3.0 * kNormal50, 1e-9);
  EXPECT_NEAR(half[0].second, 2.0 + 3.0 * kNormal50, 1e-9);
  EXPECT_NEAR(calcCredibility(normal, 2.0 - 3.0 * kNormal95), 0.95, 1e-12);
  EXPECT_NEAR(calcDepth(normal, 2.0 + 3.0 * 1.3), 1.3, 1e-9);
  EXPECT_NEAR(calcCredibility(normal, 2.0), 0.0, 1e-6);
  EXPECT_EQ(calcCredibility(normal, 1e6), 1.0);
  // Gneiting and Raftery 2007, eq. 21, at z = 1
  const double z = 1.0, phi = std::exp(-0.5) / std::sqrt(2.0 * M_PI), below = 0.8413447460685429;
  EXPECT_NEAR(calcCrps(normal, 5.0), 3.0 * (z * (2.0 * below - 1.0) + 2.0 * phi - 1.0 / std::sqrt(M_PI)),
              1e-13);
}

TEST(MarginalMixture, OfAnswersApartHasSetsOfSeveralIntervals) {
  const MarginalMixture two = makeTwo();
  const Intervals set = findHighestDensity(two, 0.95);
  ASSERT_EQ(set.size(), 2U);
  double probability = 0.0;
  for (const auto& [lower, upper] : set) {
    probability += integrate(lower, upper, [&](double x) { return two.calcDensity(x); });
    EXPECT_NEAR(two.calcDensity(lower), two.calcDensity(set[0].first), 1e-9);
    EXPECT_NEAR(two.calcDensity(upper), two.calcDensity(set[0].first), 1e-9);
  }
  EXPECT_NEAR(probability, 0.95, 1e-9);
  EXPECT_NEAR(calcCredibility(two, set[1].second), 0.95, 1e-9);
  EXPECT_GT(calcCredibility(two, 0.0), 0.99);  // between the answers, where the mean nearly is
}

TEST(MarginalMixture, CrpsIsTheIntegratedSquareOfTheDistribution) {
  const MarginalMixture two = makeTwo();
  for (const double truth : {-4.0, 0.5, 6.0}) {
    const double expected =
        integrate(-30.0, truth, [&](double x) { return std::pow(two.calcProbability(x), 2); }) +
        integrate(truth, 30.0, [&](double x) { return std::pow(two.calcProbability(x) - 1.0, 2); });
    EXPECT_NEAR(calcCrps(two, truth), expected, 1e-6);
  }
}

Mixture makeJoint() {
  Mixture mixture{Vector2d(0.25, 0.75), MatrixXd(2, 2), MatrixXd(2, 2), {Matrix2d(), Matrix2d()}};
  mixture.means << -4.0, 3.0, 1.0, 2.0;
  mixture.stddevs << 0.5, 1.0, 0.2, 2.0;
  mixture.correlations[0] << 1.0, 0.8, 0.8, 1.0;
  mixture.correlations[1] << 1.0, -0.3, -0.3, 1.0;
  return mixture;
}

TEST(Mixture, DensityIsTheSumOfItsComponents) {
  const Mixture mixture = makeJoint();
  const Vector2d point(0.3, 1.4);
  double expected = 0.0;
  for (int c = 0; c < 2; ++c) {
    const double r = mixture.correlations[static_cast<std::size_t>(c)](0, 1);
    const double a = (point[0] - mixture.means(0, c)) / mixture.stddevs(0, c);
    const double b = (point[1] - mixture.means(1, c)) / mixture.stddevs(1, c);
    expected += mixture.weights[c] * std::exp(-0.5 * (a * a - 2.0 * r * a * b + b * b) / (1.0 - r * r)) /
                (2.0 * M_PI * std::sqrt(1.0 - r * r) * mixture.stddevs.col(c).prod());
  }
  EXPECT_NEAR(MixtureDensity(mixture).calcLog(point), std::log(expected), 1e-12);
  EXPECT_EQ(findLikeliest(mixture), 0);  // lighter, but far narrower
  EXPECT_TRUE(isMultimodal(mixture));
}

TEST(Mixture, MomentsAreThoseOfItsDraws) {
  const Mixture mixture = makeJoint();
  constexpr int kDraws = 200000;
  const MatrixXd draws = drawFrom(mixture, kDraws, {1, RandomPurpose::kEnsemble});
  const VectorXd mean = draws.rowwise().mean();
  const MatrixXd centered = draws.colwise() - mean;
  EXPECT_LT((mean - calcMean(mixture)).norm(), 0.03);
  EXPECT_LT((centered * centered.transpose() / kDraws - calcCovariance(mixture)).norm(), 0.1);
}

TEST(Mixture, ConvertsMeansAndStandardDeviations) {
  Mixture mixture = makeJoint();
  convert(Vector2d(1.0, 2.0), Vector2d(10.0, 100.0), Vector2d(1.5, 2.0), mixture);
  EXPECT_EQ(mixture.means(1, 0), 102.0);
  EXPECT_EQ(mixture.stddevs(0, 1), 15.0);
  EXPECT_EQ(mixture.stddevs(1, 1), 400.0);
}

}  // namespace
}  // namespace twinmap
