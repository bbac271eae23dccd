#include "framework/analysis/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/analysis/joint_metrics.hpp"
#include "framework/analysis/metrics.hpp"
#include "framework/base/random/random.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double calcProbability(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

// The definition, integral of (F(x) - [x >= true])^2, by the midpoint rule on either side of the jump.
double integrateCrps(double truth, double mean, double stddev) {
  constexpr int kPoints = 20000;
  const double reach = 12 * stddev + std::abs(truth - mean);
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double step = reach / kPoints, away = (i + 0.5) * step;
    const double below = calcProbability((truth - away - mean) / stddev);
    const double above = 1 - calcProbability((truth + away - mean) / stddev);
    sum += step * (below * below + above * above);
  }
  return sum;
}

TEST(Crps, EqualsItsDefinition) {
  for (const double stddev : {0.02, 1.0, 30.0}) {
    for (const double z : {-7.0, -1.3, 0.0, 0.4, 2.5}) {
      const double value = calcCrps(ArrayXd::Constant(1, z), ArrayXd::Constant(1, stddev))[0];
      EXPECT_NEAR(value / integrateCrps(5.0, 5.0 + z * stddev, stddev), 1.0, 1e-6) << stddev << " " << z;
    }
  }
}

// At z = 0: (sqrt(2) - 1) / sqrt(pi), 0.2337 of the stddev; far out: |error| less stddev / sqrt(pi).
TEST(Crps, IsRelativeToTheParameterInTheMetrics) {
  ParameterSpec parameter;
  parameter.bounds = {-8, -2, {}};
  const Eigen::RowVector2d truth(-4, -4);
  const Estimates exact{truth, Eigen::RowVector2d(0.1, 0.1)};
  const double crps = 0.1 * (std::sqrt(2.0) - 1) / std::sqrt(M_PI);
  EXPECT_NEAR(calcMetrics({parameter}, truth, exact).at(0).crps_pct, 100 * crps / 4, 1e-12);
  const Estimates far{truth.array() + 3.0, Eigen::RowVector2d(0.1, 0.1)};
  EXPECT_NEAR(calcMetrics({parameter}, truth, far).at(0).crps_pct, 100 * (3 - 0.1 / std::sqrt(M_PI)) / 4,
              1e-10);
}

TEST(Pit, IsTheProbabilityBelowTheTruth) {
  const Eigen::RowVector4d truth(1.0, 2.0, 0.0, 3.0);
  const Estimates predictions{Eigen::RowVector4d::Ones(), Eigen::RowVector4d(1, 1, 2, 1e-3)};
  const MatrixXd pit = calcPit(truth, predictions);
  EXPECT_NEAR(pit(0), 0.5, 1e-15);
  EXPECT_NEAR(pit(1), 0.841344746068543, 1e-14);
  EXPECT_NEAR(pit(2), 0.308537538725987, 1e-14);
  EXPECT_EQ(pit(3), 1.0);
  EXPECT_EQ(countPit(pit.row(0).transpose()), (std::vector<int>{0, 0, 0, 1, 0, 1, 0, 0, 1, 1}));
  EXPECT_EQ(countPit(ArrayXd::Zero(3))[0], 3);
  EXPECT_EQ(countPit(ArrayXd::Zero(3), Eigen::Vector3d(0, 2.5, 2))[0], 5);  // 4.5
  EXPECT_EQ(countPit(ArrayXd::Constant(2, std::nan(""))), std::vector<int>(kPitBins, 0));
}

constexpr int kCalibratedSamples = 20000;

/// Three parameters p ~ N(0, I) seen through four features A p + noise of stddev 0.5; the exact posterior is
/// normal with covariance C = (I + A'A / 0.25)^-1 and mean C A'x / 0.25.
struct LinearGaussian {
  MatrixXd truth = MatrixXd(3, kCalibratedSamples), correlation;
  Estimates posterior;
  VectorXd stddev;
};

LinearGaussian makeLinearGaussian() {
  constexpr double kNoiseVariance = 0.25;
  const RandomStream random(11, RandomPurpose::kTestNoise);
  MatrixXd a(4, 3), features(4, kCalibratedSamples);
  a << 1, 0.8, 0, 0.5, 1, 0.3, 0, 0.2, 0.4, 1, 1, 1;
  LinearGaussian problem;
  for (int i = 0; i < kCalibratedSamples; ++i) {
    for (int p = 0; p < 3; ++p) {
      problem.truth(p, i) = random.calcNormal(i, p);
    }
    features.col(i) = a * problem.truth.col(i);
    for (int f = 0; f < 4; ++f) {
      features(f, i) += std::sqrt(kNoiseVariance) * random.calcNormal(i, 10 + f);
    }
  }
  const MatrixXd precision = MatrixXd::Identity(3, 3) + a.transpose() * a / kNoiseVariance;
  const MatrixXd covariance = test::calcInverse(precision);
  problem.stddev = covariance.diagonal().cwiseSqrt();
  problem.correlation =
      problem.stddev.cwiseInverse().asDiagonal() * covariance * problem.stddev.cwiseInverse().asDiagonal();
  problem.posterior = {covariance * a.transpose() * features / kNoiseVariance,
                       problem.stddev.replicate(1, kCalibratedSamples)};
  return problem;
}

std::vector<ParameterMetrics> calcMetricsOf(const LinearGaussian& problem, double stddev_factor) {
  ParameterSpec parameter;
  parameter.bounds = {-1, 1, {}};
  parameter.relative_to = RelativeTo::kRange;
  return calcMetrics({3, parameter}, problem.truth,
                     {problem.posterior.mean, stddev_factor * problem.posterior.stddev});
}

/// Pearson's statistic of a flat histogram: chi-square with 9 degrees of freedom.
double calcChiSquared(const std::vector<int>& counts) {
  const double expected = kCalibratedSamples / double(kPitBins);
  double sum = 0;
  for (const int count : counts) {
    sum += (count - expected) * (count - expected) / expected;
  }
  return sum;
}

constexpr double kChiSquared999 = 27.88;  // of 9 degrees of freedom
constexpr double kErrors = 4.0;           // standard errors that a figure may be off

TEST(Calibration, TheExactPosteriorIsCalibrated) {
  const LinearGaussian problem = makeLinearGaussian();
  for (const ParameterMetrics& m : calcMetricsOf(problem, 1.0)) {
    EXPECT_NEAR(m.coverage95, 0.95, kErrors * std::sqrt(0.95 * 0.05 / kCalibratedSamples));
    EXPECT_NEAR(m.coverage90, 0.90, kErrors * std::sqrt(0.90 * 0.10 / kCalibratedSamples));
    EXPECT_NEAR(m.coverage50, 0.50, kErrors * std::sqrt(0.50 * 0.50 / kCalibratedSamples));
    EXPECT_NEAR(m.z_mean, 0.0, kErrors / std::sqrt(kCalibratedSamples));
    EXPECT_NEAR(m.z_sd, 1.0, kErrors / std::sqrt(2.0 * kCalibratedSamples));
    EXPECT_NEAR(m.sd_pct / m.stddev_pct, 1.0, kErrors / std::sqrt(2.0 * kCalibratedSamples));
    // The standard errors are those of these known distributions.
    EXPECT_NEAR(m.se.coverage50, std::sqrt(0.25 / kCalibratedSamples), 1e-5);
    EXPECT_NEAR(m.se.z_mean * std::sqrt(kCalibratedSamples), 1.0, 0.03);
    EXPECT_NEAR(m.se.z_sd * std::sqrt(2.0 * kCalibratedSamples), 1.0, 0.05);
  }
  const MatrixXd pit = calcPit(problem.truth, problem.posterior);
  for (int p = 0; p < 3; ++p) {
    EXPECT_LT(calcChiSquared(countPit(pit.row(p).transpose())), kChiSquared999);
  }
}

TEST(Calibration, OverAndUnderconfidenceAreFoundAndScoreWorse) {
  const LinearGaussian problem = makeLinearGaussian();
  const std::vector<ParameterMetrics> calibrated = calcMetricsOf(problem, 1.0);
  for (const double factor : {0.8, 1.25}) {
    const std::vector<ParameterMetrics> wrong = calcMetricsOf(problem, factor);
    const MatrixXd pit = calcPit(problem.truth, {problem.posterior.mean, factor * problem.posterior.stddev});
    for (int p = 0; p < 3; ++p) {
      // P(|z| < q factor) of a normal z.
      EXPECT_NEAR(wrong[p].coverage95, 2 * calcProbability(1.959964 * factor) - 1, 0.01);
      EXPECT_NEAR(wrong[p].z_sd, 1 / factor, 0.03);
      EXPECT_GT(wrong[p].nlpd, calibrated[p].nlpd);
      EXPECT_GT(wrong[p].crps_pct, calibrated[p].crps_pct);
      const std::vector<int> counts = countPit(pit.row(p).transpose());
      EXPECT_GT(calcChiSquared(counts), 10 * kChiSquared999);
      EXPECT_EQ(counts[0] > counts[5], factor < 1);  // a U where the stddev is too small
    }
  }
}

TEST(JointCalibration, NeedsTheCorrelationOfTheExactPosterior) {
  const LinearGaussian problem = makeLinearGaussian();
  const MatrixXd identity = MatrixXd::Identity(3, 3);
  EXPECT_GT((problem.correlation - identity).cwiseAbs().maxCoeff(), 0.3);  // there is something to find
  Estimates posterior = problem.posterior;
  posterior.correlations = {problem.correlation};
  const JointMetrics calibrated = calcJointMetrics(problem.truth, posterior);
  EXPECT_NEAR(calibrated.coverage95, 0.95, kErrors * calibrated.se.coverage95);
  EXPECT_NEAR(calibrated.coverage90, 0.90, kErrors * calibrated.se.coverage90);
  EXPECT_NEAR(calibrated.coverage50, 0.50, kErrors * calibrated.se.coverage50);
  // The entropy of a normal distribution: p/2 (1 + log 2 pi) + 1/2 log|C|.
  const double entropy = 1.5 * (1 + std::log(2 * M_PI)) + problem.stddev.array().log().sum() +
                         0.5 * std::log(test::calcDeterminant(problem.correlation));
  EXPECT_NEAR(calibrated.nlpd, entropy, kErrors * calibrated.se.nlpd);
  EXPECT_NEAR(calibrated.se.nlpd, std::sqrt(0.5 * 3 / kCalibratedSamples), 1e-4);  // half a chi-square of 3
  posterior.correlations = {identity};
  const JointMetrics independent = calcJointMetrics(problem.truth, posterior);
  EXPECT_GT(independent.nlpd, calibrated.nlpd + 20 * calibrated.se.nlpd);
  EXPECT_GT(std::abs(independent.coverage50 - 0.5), 5 * calibrated.se.coverage50);
}

// Two samples by hand: R = [1 0.6; 0.6 1], |R| = 0.64; z = (1, 1): d^2 = 2 / 1.6 = 1.25; z = (2, -2):
// d^2 = 8 / 0.4 = 20. Chi-square of 2 degrees of freedom: quantiles -2 log(1 - P) = 1.386, 4.6, 5.99.
TEST(JointCalibration, ByHand) {
  const Eigen::Matrix2d truth = Eigen::Matrix2d::Zero();
  Estimates predictions{MatrixXd(2, 2), MatrixXd(2, 2)};
  predictions.mean << 1, 2, 3, -6;
  predictions.stddev << 1, 1, 3, 3;
  Eigen::Matrix2d correlation;
  correlation << 1, 0.6, 0.6, 1;
  predictions.correlations = {correlation};
  const JointMetrics metrics = calcJointMetrics(truth, predictions);
  EXPECT_DOUBLE_EQ(metrics.coverage50, 0.5);
  EXPECT_DOUBLE_EQ(metrics.coverage95, 0.5);
  EXPECT_NEAR(metrics.nlpd, 0.5 * (1.25 + 20) / 2 + std::log(3.0) + 0.5 * std::log(0.64) + std::log(2 * M_PI),
              1e-12);
  EXPECT_NEAR(metrics.se.nlpd, 0.5 * (20 - 1.25) / 2, 1e-12);  // sd of two values / sqrt(2)
}

}  // namespace
}  // namespace twinmap
