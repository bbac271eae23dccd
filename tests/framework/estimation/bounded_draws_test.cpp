#include "framework/estimation/bounded_draws.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>

#include "framework/base/random/random.hpp"
#include "framework/estimation/estimate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kManyDraws = 20000;

/// Draws of N(mean, 1) cut at the bounds, by their quantile function.
BoundedDraws drawWithin(double mean, double lower, double upper, std::uint64_t sample = 0,
                        Index count = kManyDraws) {
  const boost::math::normal normal(mean, 1.0);
  const RandomStream random(3, RandomPurpose::kPosterior);
  const double from = cdf(normal, lower), to = cdf(normal, upper);
  BoundedDraws draws{VectorXd(count).transpose(), VectorXd::Constant(count, 1.0 / static_cast<double>(count)),
                     VectorXd::Constant(1, lower), VectorXd::Constant(1, upper)};
  for (Index i = 0; i < count; ++i) {
    const double share = random.calcUniform(static_cast<std::uint64_t>(i), 0, sample);
    draws.points(0, i) = quantile(normal, from + share * (to - from));
  }
  return draws;
}

TEST(BoundedDraws, HaveAnIntervalWithAsMuchOnEitherSideAwayFromTheBounds) {
  const auto [lower, upper] = drawWithin(0.0, -20.0, 20.0).findInterval(0, 0.95);
  EXPECT_NEAR(lower, -1.96, 0.07);  // three standard errors of a quantile
  EXPECT_NEAR(upper, 1.96, 0.07);
}

TEST(BoundedDraws, HaveAnIntervalThatBeginsAtABoundWhereTheyAreDense) {
  const BoundedDraws at_lower = drawWithin(0.0, 0.0, 50.0);
  const auto [lower, upper] = at_lower.findInterval(0, 0.95);
  EXPECT_EQ(lower, 0.0);
  EXPECT_NEAR(upper, 1.96, 0.06);  // 95 % of half a normal distribution
  const auto [from, to] = drawWithin(-1.0, -30.0, 0.0).findInterval(0, 0.5);
  EXPECT_LT(from, to);
  EXPECT_LT(to, 0.0);  // half of it lies about its mode, a standard deviation below the bound
  EXPECT_EQ(drawWithin(0.3, -30.0, 0.0).findInterval(0, 0.95).second, 0.0);
}

TEST(BoundedDraws, HoldATruthAtTheBoundAsOftenAsTheySay) {
  constexpr int kMeasurements = 400;
  const RandomStream random(4, RandomPurpose::kTestNoise);
  int held = 0;
  for (std::uint64_t i = 0; i < kMeasurements; ++i) {  // a truth of 0 measured with noise 1, at least 0
    const BoundedDraws draws = drawWithin(random.calcNormal(i, 0), 0.0, 50.0, i + 1, 400);
    held += draws.findInterval(0, 0.95).first == 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(held / double{kMeasurements}, 0.95, 0.04);
}

/// The posterior of damping and friction (at least 0), normal but for that, with correlation -.8.
BoundedDraws drawDampingAndFriction(double damping, double friction, std::uint64_t sample) {
  constexpr double kCorrelation = -0.8;
  const BoundedDraws alone = drawWithin(friction, 0.0, 50.0, sample, 400);
  const RandomStream random(5, RandomPurpose::kPosterior);
  BoundedDraws draws{Eigen::MatrixXd(2, alone.points.cols()), alone.weights, Eigen::Vector2d(-50.0, 0.0),
                     Eigen::Vector2d(50.0, 50.0)};
  draws.points.row(1) = alone.points;
  for (Index i = 0; i < alone.points.cols(); ++i) {
    draws.points(0, i) = damping + kCorrelation * (alone.points(0, i) - friction) +
                         0.6 * random.calcNormal(static_cast<std::uint64_t>(i), 0, sample);
  }
  return draws;
}

TEST(BoundedDraws, HoldADampingWhoseMachineHasNoFriction) {
  constexpr int kMeasurements = 400;
  const RandomStream random(6, RandomPurpose::kTestNoise);
  int held = 0;
  for (std::uint64_t i = 0; i < kMeasurements; ++i) {  // truths of 0 measured with noise of that correlation
    const double friction = random.calcNormal(i, 0);
    const double damping = -0.8 * friction + 0.6 * random.calcNormal(i, 1);
    const auto [lower, upper] = drawDampingAndFriction(damping, friction, i + 1).findInterval(0, 0.95);
    held += lower <= 0.0 && 0.0 <= upper ? 1 : 0;
  }
  EXPECT_NEAR(held / double{kMeasurements}, 0.95, 0.03);
}

TEST(BoundedDraws, KeepTheirIntervalWhereFrictionIsSeen) {
  const BoundedDraws draws = drawDampingAndFriction(1.0, 6.0, 1);
  const auto [lower, upper] = draws.findInterval(0, 0.95);
  const VectorXd quantiles = draws.calcQuantiles(0, Eigen::Vector2d(0.025, 0.975));
  EXPECT_DOUBLE_EQ(lower, quantiles[0]);
  EXPECT_DOUBLE_EQ(upper, quantiles[1]);
}

TEST(BoundedDraws, GiveAnEstimateItsIntervals) {
  Estimate estimate{VectorXd::Constant(1, 0.8), VectorXd::Constant(1, 0.6)};
  estimate.draws = drawWithin(0.0, 0.0, 50.0);
  EXPECT_EQ(estimate.calcBounds95().lower[0], 0.0);
  EXPECT_NEAR(estimate.calcBounds95().upper[0], 1.96, 0.06);
  EXPECT_FALSE(estimate.isMultimodal());
}

TEST(BoundedDraws, WithModesThatLieApartGiveAnIntervalForEach) {
  Estimate estimate{VectorXd::Zero(1), VectorXd::Constant(1, 3.0)};
  estimate.draws = drawWithin(0.0, -3.5, 20.0);
  estimate.mixture = {Eigen::Vector2d(0.5, 0.5),
                      Eigen::RowVector2d(-3.0, 3.0),
                      Eigen::RowVector2d(0.5, 0.5),
                      {Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Ones(1, 1)}};
  const Intervals intervals = estimate.findIntervals(0, Coverage::k95);
  ASSERT_EQ(intervals.size(), 2U);
  EXPECT_EQ(intervals[0].first, -3.5);  // the bound
  EXPECT_NEAR(intervals[0].second, -3.0 + 1.96 * 0.5, 1e-2);
  EXPECT_TRUE(estimate.isMultimodal());
}

}  // namespace
}  // namespace twinmap
