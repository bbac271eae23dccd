#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "framework/estimation/interval_factor.hpp"

namespace twinmap {
namespace {

/// Absolute values of a standard normal variable, evenly spread over its distribution, times a factor.
Eigen::VectorXd makeErrors(Eigen::Index count, double factor) {
  const boost::math::normal standard;
  Eigen::VectorXd errors(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    errors(i) = factor * boost::math::quantile(standard, 0.5 + 0.5 * share);
  }
  return errors;
}

TEST(StddevScale, IsOneForCalibratedErrorsAndTheFactorForTooLargeOnes) {
  EXPECT_NEAR(calcStddevScale(makeErrors(1000, 1.0)), 1.0, 0.02);
  EXPECT_NEAR(calcStddevScale(makeErrors(1000, 2.5)), 2.5, 0.05);
}

TEST(StddevScale, FollowsTheTailWhereItIsHeavy) {
  Eigen::VectorXd errors = makeErrors(1000, 1.0);
  errors.tail(100) *= 3.0;
  EXPECT_NEAR(calcStddevScale(errors), 3.0, 0.1);  // nineteen of twenty lie within three times 1.96
}

double calcShare(const Eigen::VectorXd& errors, double within) {
  return (errors.array() < within).cast<double>().mean();
}

TEST(StddevScale, BalancesWhatTheTailsOfManyErrorsTakeFromTheMiddle) {
  Eigen::VectorXd errors = makeErrors(20000, 1.0);
  errors *= 0.8;
  errors.tail(2000) *= 1.5;  // 95 % intervals alone would ask for a factor at which 50 % intervals hold .58
  const double scale = calcStddevScale(errors);
  const double half = calcShare(errors, 0.67449 * scale) - 0.5,
               most = calcShare(errors, 1.95996 * scale) - 0.95;
  EXPECT_NEAR(half, -2.0 * most, 1e-3);
  EXPECT_GT(half, 0.01);
}

TEST(StddevScale, OfManyErrorsWithLightTailsIsThatOfFew) {
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(20000, 0.0, std::sqrt(3.0));  // of variance 1
  EXPECT_NEAR(calcStddevScale(even), 0.68 * std::sqrt(3.0) / 0.994458, 1e-3);
}

TEST(TypicalStddev, IsTheGeometricMean) {
  EXPECT_NEAR(calcTypicalStddev(Eigen::RowVector2d(2.0, 8.0))[0], 4.0, 1e-12);
}

TEST(StddevScale, IsNoLargerForManyErrorsThanForFew) {
  for (const Eigen::Index count : {3000, 20000}) {
    EXPECT_NEAR(calcStddevScale(makeErrors(count, 1.7)), 1.7, 0.01);
    EXPECT_NEAR(calcStddevScale(makeErrors(count, 0.6)), 0.6, 0.01);
    const Eigen::VectorXd apart = Eigen::VectorXd::Ones(count);  // two answers
    EXPECT_NEAR(calcStddevScale(apart), 1.0056, 1e-3);
  }
}

TEST(StddevScale, FallsBelowOneOnlyBeyondDoubt) {
  EXPECT_EQ(calcStddevScale(makeErrors(50, 0.85)), 1.0);
  const double scale = calcStddevScale(makeErrors(2000, 0.5));
  EXPECT_GT(scale, 0.5);
  EXPECT_LT(scale, 0.6);
}

}  // namespace
}  // namespace twinmap
