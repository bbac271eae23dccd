#include "framework/estimation/interval_factor.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>

#include "framework/estimation/estimate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Absolute values of n standard normal numbers, spread as evenly as can be.
VectorXd makeNormalDepths(Index n) {
  return VectorXd::NullaryExpr(n, [&](Index i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    return boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + share));
  });
}

/// Of numbers uniform on [-sqrt 3, sqrt 3], whose standard deviation is 1.
VectorXd makeUniformDepths(Index n) {
  return VectorXd::LinSpaced(n, 0.0, std::sqrt(3.0));
}

TEST(IntervalFactors, ConformalQuantilesAreOrderStatistics) {
  const VectorXd sorted = VectorXd::LinSpaced(9, 1.0, 9.0);
  EXPECT_EQ(calcConformalQuantile(sorted, 0.5), 5.0);   // rank 5 of 10
  EXPECT_EQ(calcConformalQuantile(sorted, 0.51), 6.0);  // rank 5.1, rounded up
  EXPECT_EQ(calcConformalQuantile(sorted, 0.95), 9.0);  // rank 9.5: there are too few
}

TEST(IntervalFactors, TellsDepthsThatANormalDistributionWouldHave) {
  const IntervalFactor factor{1.0, 1.5};
  EXPECT_EQ(factor.calcEquivalentZ(0.5), 0.5 * kNormal50);
  EXPECT_EQ(factor.calcEquivalentZ(1.0), kNormal50);
  EXPECT_EQ(factor.calcEquivalentZ(1.25), 0.5 * (kNormal50 + kNormal95));
  EXPECT_EQ(factor.calcEquivalentZ(1.5), kNormal95);
  EXPECT_EQ(factor.calcEquivalentZ(3.0), 2.0 * kNormal95);
  EXPECT_EQ(IntervalFactor{}.calcEquivalentZ(kNormal95), kNormal95);
  EXPECT_NEAR(IntervalFactor{}.calcEquivalentZ(1.3), 1.3, 1e-15);
}

TEST(IntervalFactors, OfNormalErrorsIsThatOfNormalDistributions) {
  const IntervalFactor factor = calcIntervalFactor(makeNormalDepths(1000), 1000.0);
  EXPECT_EQ(factor.of50, kNormal50);
  EXPECT_EQ(factor.of95, kNormal95);
}

TEST(IntervalFactors, IsNotForErrorsThatAreSmallerOrLarger) {
  for (const double factor : {0.8, 1.3}) {
    EXPECT_EQ(calcIntervalFactor(factor * makeNormalDepths(1000), 1000.0).of95, kNormal95);
  }
}

TEST(IntervalFactors, OfOtherErrorsHoldsWhatItSays) {
  const IntervalFactor factor = calcIntervalFactor(makeUniformDepths(1001), 1001.0);
  EXPECT_NEAR(factor.of50, 0.50 * std::sqrt(3.0), 2e-3);
  EXPECT_NEAR(factor.of95, 0.95 * std::sqrt(3.0), 2e-3);
}

/// Truths about means of 0 with standard deviations of 1: a uniform parameter and a normal one.
struct Errors {
  Estimates predictions;
  MatrixXd truth;

  explicit Errors(Index n) : predictions{MatrixXd::Zero(2, n), MatrixXd::Ones(2, n)}, truth(2, n) {
    truth.row(0) = makeUniformDepths(n).transpose();
    truth.row(1) = makeNormalDepths(n).transpose();
  }
};

TEST(IntervalFactors, IsEachParametersOwn) {
  const Errors errors(1000);
  const IntervalFactors factors = calcIntervalFactors(errors.predictions, errors.truth, 1);
  ASSERT_TRUE(factors.isGiven());
  EXPECT_NEAR(factors.get(0).of95, 0.95 * std::sqrt(3.0), 4e-3);
  EXPECT_EQ(factors.get(1).of95, kNormal95);
  const IntervalFactors of_each = replicate(factors, 3);
  EXPECT_EQ(of_each.get(0, 2).of50, factors.get(0).of50);
  ASSERT_EQ(takeFactors(of_each, 1).size(), 3U);
  EXPECT_EQ(takeFactors(of_each, 1)[2].of50, kNormal50);
}

TEST(IntervalFactors, IsNotGivenWhereErrorsAreNormalOrFew) {
  const Errors errors(1000);
  EXPECT_FALSE(calcIntervalFactors(errors.predictions, errors.truth, 4).isGiven());
  const Estimates normal{errors.predictions.mean.row(1), errors.predictions.stddev.row(1)};
  EXPECT_FALSE(calcIntervalFactors(normal, errors.truth.row(1), 1).isGiven());
  EXPECT_EQ(IntervalFactors{}.get(0).of95, kNormal95);
  EXPECT_TRUE(takeFactors({}, 0).empty());
}

}  // namespace
}  // namespace twinmap
