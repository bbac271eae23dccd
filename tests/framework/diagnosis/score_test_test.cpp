#include "framework/diagnosis/problem/score_test.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd drawNormals(Index rows, Index columns, std::uint64_t seed) {
  MatrixXd numbers(rows, columns);
  const RandomStream random(seed, RandomPurpose::kTestNoise);
  for (Index i = 0; i < columns; ++i) {
    random.drawNormals(static_cast<std::uint64_t>(i), 0, numbers.col(i).data(),
                       static_cast<std::size_t>(rows));
  }
  return numbers;
}

constexpr Index kResiduals = 60, kParameters = 3;

class Scores : public testing::Test {
 protected:
  const MatrixXd jacobian_ = drawNormals(kResiduals, kParameters, 1);
  const MatrixXd terms_ = drawNormals(kResiduals, 2, 2);
  const VectorXd residual_ = drawNormals(kResiduals, 1, 3).col(0) + 0.5 * terms_.col(0);
};

TEST_F(Scores, AreThoseOfLeastSquaresWithTheTerm) {
  MatrixXd columns(kResiduals, kParameters + 1);
  columns << jacobian_, terms_.col(0);
  const MatrixXd normal = columns.transpose() * columns;
  const VectorXd with = linalg::solveLinear(normal, columns.transpose() * residual_);
  const VectorXd without =
      linalg::solveLinear(jacobian_.transpose() * jacobian_, jacobian_.transpose() * residual_);
  const double variance =
      linalg::solveLinear(normal, VectorXd::Unit(kParameters + 1, kParameters))[kParameters];
  const double gain =
      (residual_ - jacobian_ * without).squaredNorm() - (residual_ - columns * with).squaredNorm();

  const TermScore score = ScoreTest(residual_, jacobian_, terms_).calcScore(0, 1.0);
  ASSERT_TRUE(score.visible);
  EXPECT_NEAR(score.estimate, with[kParameters], 1e-12);
  EXPECT_NEAR(score.stddev, std::sqrt(variance), 1e-12);
  EXPECT_NEAR(score.z * score.z, gain, 1e-10);
  for (Index j = 0; j < kParameters; ++j) {
    EXPECT_NEAR(score.shifts[j], with[j] - without[j], 1e-12);
  }
}

TEST_F(Scores, DoNotSeeWhatTheParametersTakeUp) {
  MatrixXd terms(kResiduals, 2);
  terms << jacobian_ * Eigen::Vector3d(1.0, -2.0, 0.5), 1e-3 * terms_.col(0);
  const ScoreTest test(residual_, jacobian_, terms);
  EXPECT_FALSE(test.calcScore(0, 1.0).visible);
  EXPECT_FALSE(test.calcScore(1, 1.0).visible);  // below a tenth of the noise
  EXPECT_TRUE(test.calcScore(1, 100.0).visible);
}

TEST_F(Scores, SayWhichTermsAreAlike) {
  MatrixXd terms(kResiduals, 2);
  terms << terms_.col(0), -3.0 * terms_.col(0) + jacobian_.col(1);
  EXPECT_NEAR(ScoreTest(residual_, jacobian_, terms).calcLikeness(0, 1), 1.0, 1e-12);
  EXPECT_LT(ScoreTest(residual_, jacobian_, terms_).calcLikeness(0, 1), 0.5);
}

// Two terms at once against least squares with both.
TEST_F(Scores, AreThoseOfTwoTermsTogether) {
  const ScoreTest test(residual_, jacobian_, terms_);
  const ScoreTest::JointScore joint = test.calcJointScore({0, 1});
  MatrixXd columns(kResiduals, kParameters + 2);
  columns << jacobian_, terms_;
  const VectorXd with = linalg::solveLinear(columns.transpose() * columns, columns.transpose() * residual_);
  const VectorXd without =
      linalg::solveLinear(jacobian_.transpose() * jacobian_, jacobian_.transpose() * residual_);
  const VectorXd left = residual_ - jacobian_ * without;
  const double gain = left.squaredNorm() - (residual_ - columns * with).squaredNorm();
  EXPECT_NEAR(joint.estimates[0], with[kParameters], 1e-12);
  EXPECT_NEAR(joint.estimates[1], with[kParameters + 1], 1e-12);
  EXPECT_NEAR(joint.gain, gain, 1e-9);
  EXPECT_NEAR(test.calcPairGains()(0, 1), gain, 1e-9);
  for (Index j = 0; j < kParameters; ++j) {
    EXPECT_NEAR(joint.shifts[j], with[j] - without[j], 1e-12);
  }
  const MatrixXd beside = terms_ - jacobian_ * linalg::fitLinear(jacobian_, terms_).coefficients;
  const MatrixXd gram = beside.transpose() * beside;
  EXPECT_NEAR(joint.stddevs[0], 1.0 / std::sqrt(gram(0, 0)), 1e-12);
  EXPECT_NEAR(joint.stddevs[1], std::sqrt(gram(0, 0) / (gram(0, 0) * gram(1, 1) - gram(0, 1) * gram(0, 1))),
              1e-12);
}

TEST_F(Scores, RefusePairsThatAreAlike) {
  MatrixXd terms(kResiduals, 2);
  terms << terms_.col(0), 2.0 * terms_.col(0);
  const ScoreTest test(residual_, jacobian_, terms);
  EXPECT_EQ(test.calcJointScore({0, 1}).estimates.size(), 0);
  EXPECT_EQ(test.calcPairGains()(0, 1), 0.0);
}

TEST_F(Scores, AreNoMoreCertainThanWhatRemains) {
  const ScoreTest white(residual_, jacobian_, terms_);
  const double stated = white.calcScore(0, 1.0).stddev;
  EXPECT_NEAR(white.calcCautiousStddev(0, {0}), stated, 0.3 * stated);
  EXPECT_NEAR(ScoreTest(0.1 * residual_, jacobian_, terms_).calcCautiousStddev(0, {0}), stated, 1e-12);
  const ScoreTest loud(10.0 * residual_, jacobian_, terms_), louder(100.0 * residual_, jacobian_, terms_);
  EXPECT_NEAR(louder.calcCautiousStddev(0, {0}) / loud.calcCautiousStddev(0, {0}), 10.0, 1e-9);
  EXPECT_GT(loud.calcCautiousStddev(0, {0}), 5.0 * stated);
}

// A slow term in slow noise of correlation rho: its sd is larger by about sqrt((1 + rho) / (1 - rho)).
TEST(CautiousStddev, FollowsTheColourOfWhatRemains) {
  constexpr Index kMany = 2000;
  constexpr double kRho = 0.9;
  VectorXd noise = drawNormals(kMany, 1, 5).col(0);
  for (Index i = 1; i < kMany; ++i) {
    noise[i] = kRho * noise[i - 1] + std::sqrt(1.0 - kRho * kRho) * noise[i];
  }
  const MatrixXd constant = MatrixXd::Ones(kMany, 1), alternating = VectorXd::Unit(kMany, 0);
  const ScoreTest test(noise, alternating, constant);
  const double ratio = test.calcCautiousStddev(0, {0}) / test.calcScore(0, 1.0).stddev;
  EXPECT_NEAR(ratio, std::sqrt((1.0 + kRho) / (1.0 - kRho)), 0.6);
}

TEST(PairPValue, IsThatOfChiSquareOfTwoDegrees) {
  EXPECT_NEAR(calcPairPValue(9.210340, 1.0), 0.01, 1e-6);  // tables of chi-square
  EXPECT_EQ(calcPairPValue(1.0, 100.0), 1.0);
}

TEST(CriticalZ, IsExceededAtItsLevel) {
  EXPECT_NEAR(calcCriticalZ(0.05, 1), 1.959964, 1e-6);
  EXPECT_NEAR(calcPValue(calcCriticalZ(0.01, 20), 20), 0.01, 1e-12);
  EXPECT_EQ(calcPValue(0.1, 20), 1.0);
}

// Against the integral of the likelihood exp(-(estimate - c)^2 / (2 sd^2)) over the prior, by Simpson's rule.
TEST(LogEvidence, IsTheIntegralOverThePrior) {
  const double size = 0.7, stddev = 0.2, estimate = 0.5;
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double c = -7.0 + 14.0 * i / kSteps;
    const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const double apart = (estimate - c) / stddev, scaled = c / size;
    sum += weight * std::exp(-0.5 * apart * apart - 0.5 * scaled * scaled);
  }
  const double integral = sum * 14.0 / kSteps / 3.0 / (size * std::sqrt(2.0 * M_PI));
  const double absent = std::exp(-0.5 * estimate * estimate / (stddev * stddev));
  EXPECT_NEAR(calcLogEvidence(estimate * estimate / (stddev * stddev), stddev, size),
              std::log(integral / absent), 1e-9);
}

/// log of the integral of the likelihood over the prior of any size, by sums over both logarithms.
double integrateOverSizes(double estimate, double stddev, double size) {
  constexpr int kSizes = 900, kSteps = 2000;
  double evidence = 0.0;
  for (int k = 0; k < kSizes; ++k) {
    const double wide = size * std::pow(10.0, -9.0 * (k + 0.5) / kSizes), reach = 8.0 * (wide + stddev);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double c = estimate + reach * (2.0 * (i + 0.5) / kSteps - 1.0);
      const double apart = (estimate - c) / stddev, scaled = c / wide;
      sum += std::exp(-0.5 * apart * apart - 0.5 * scaled * scaled);
    }
    evidence += sum * 2.0 * reach / kSteps / (wide * std::sqrt(2.0 * M_PI)) / kSizes;
  }
  return std::log(evidence) + 0.5 * estimate * estimate / (stddev * stddev);
}

// Against the integral over the prior, whose sizes merge: a tenth of what a tie is judged by.
TEST(LogEvidence, IsTheIntegralOverAllSizes) {
  for (const double estimate : {0.1, 0.02, 0.004}) {
    const double stddev = 0.001, gain = estimate * estimate / (stddev * stddev);
    EXPECT_NEAR(calcLogEvidence(gain, {estimate, stddev, 0.7}), integrateOverSizes(estimate, stddev, 0.7),
                0.3);
  }
}

// Two terms that explain as much are tied, whatever unit or size of theirs is thought to matter.
TEST(LogEvidence, IsThatOfTheExplanation) {
  const double first = calcLogEvidence(400.0, {0.2, 0.01, 0.3}),
               second = calcLogEvidence(400.0, {2e-5, 1e-6, 20.0});
  EXPECT_NEAR(first, second, 0.5);
  EXPECT_LT(calcLogEvidence(0.0, {0.0, 0.01, 0.3}), 0.0);
}

}  // namespace
}  // namespace twinmap
