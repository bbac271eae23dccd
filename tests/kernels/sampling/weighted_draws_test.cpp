#include "kernels/sampling/weighted_draws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace twinmap::importance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

/// (i + 1/2) / n.
VectorXd makeMidpoints(Index count) {
  return VectorXd::NullaryExpr(
      count, [&](Index i) { return (static_cast<double>(i) + 0.5) / static_cast<double>(count); });
}

TEST(WeightedDraws, WeighsByWhatIsPossible) {
  MatrixXd points(1, 3);
  points << 1.0, 2.0, 4.0;
  const WeightedDraws draws = weigh(points, Eigen::Vector3d(1000.0, 1000.0 + std::log(3.0), kImpossible));
  EXPECT_TRUE(draws.weights.isApprox(Eigen::Vector3d(0.25, 0.75, 0.0), 1e-12));
  EXPECT_NEAR(calcMean(draws)[0], 1.75, 1e-12);
  EXPECT_NEAR(calcCovariance(draws)(0, 0), 0.1875, 1e-12);
  EXPECT_NEAR(calcEffectiveSampleSize(draws), 1.6, 1e-12);
}

TEST(WeightedDraws, NothingPossibleIsNotANumber) {
  const WeightedDraws draws = weigh(MatrixXd::Zero(1, 2), VectorXd::Constant(2, kImpossible));
  EXPECT_TRUE(std::isnan(calcEffectiveSampleSize(draws)));
}

TEST(WeightedDraws, QuantilesAreThoseOfTheDistributionThatWeightsMake) {
  constexpr Index kCount = 2000;
  const VectorXd at = makeMidpoints(kCount);  // uniform on (0, 1), weighted to the density 2 x
  const WeightedDraws draws = weigh(at.transpose(), at.array().log());
  const MatrixXd quantiles = calcQuantiles(draws, Eigen::Vector3d(0.025, 0.5, 0.975));
  for (const auto& [column, probability] : {std::pair{0, 0.025}, {1, 0.5}, {2, 0.975}}) {
    EXPECT_NEAR(quantiles(0, column), std::sqrt(probability), 2.0 / kCount);
  }
}

TEST(WeightedDraws, EachPointLiesInTheMiddleOfItsWeight) {
  MatrixXd points(1, 2);
  points << 1.0, 3.0;
  const MatrixXd quantiles = calcQuantiles(weigh(points, Eigen::Vector2d(std::log(0.6), std::log(0.4))),
                                           Eigen::Vector3d(0.3, 0.55, 0.8));
  EXPECT_NEAR(quantiles(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(quantiles(0, 1), 2.0, 1e-12);
  EXPECT_NEAR(quantiles(0, 2), 3.0, 1e-12);
}

TEST(WeightedDraws, QuantilesDoNotDependOnTheOrder) {
  const VectorXd at = makeMidpoints(101), log_weights = at.array().sin();
  const MatrixXd forwards = calcQuantiles(weigh(at.transpose(), log_weights), Eigen::Vector2d(0.16, 0.84));
  const MatrixXd backwards =
      calcQuantiles(weigh(at.reverse().transpose(), log_weights.reverse()), Eigen::Vector2d(0.16, 0.84));
  EXPECT_TRUE(forwards.isApprox(backwards, 1e-12));
}

TEST(WeightedDraws, ResamplesEachPointAsOftenAsItsWeightSays) {
  MatrixXd points(1, 3);
  points << 1.0, 2.0, 3.0;
  const MatrixXd chosen =
      resample(weigh(points, Eigen::Vector3d(std::log(0.2), kImpossible, std::log(0.8))), makeMidpoints(100));
  EXPECT_EQ((chosen.array() == 1.0).count(), 20);
  EXPECT_EQ((chosen.array() == 3.0).count(), 80);
}

TEST(WeightedDraws, TemperingReachesTheSampleSizeAskedForAndNoMore) {
  const VectorXd at = makeMidpoints(200);
  const MatrixXd points = at.transpose();
  // the last by far outweigh all others, of most of which no double holds the weight
  for (const double scale : {300.0, 3e6}) {
    ASSERT_LT(calcEffectiveSampleSize(weigh(points, scale * at)), 3.0);
    EXPECT_NEAR(calcEffectiveSampleSize(temper(points, scale * at, 50.0)), 50.0, 0.1);
  }
  EXPECT_EQ(temper(points, 300.0 * at, 1.0).weights, weigh(points, 300.0 * at).weights);
}

TEST(WeightedDraws, TemperingLeavesTheImpossibleImpossible) {
  VectorXd log_weights = -3000.0 * makeMidpoints(100);
  log_weights.tail(50).setConstant(kImpossible);
  const WeightedDraws draws = temper(makeMidpoints(100).transpose(), log_weights, 80.0);
  EXPECT_TRUE((draws.weights.tail(50).array() == 0.0).all());
  EXPECT_NEAR(calcEffectiveSampleSize(draws), 50.0, 1e-3);
}

/// Weights that are quantiles of a generalised Pareto distribution, 1 added.
WeightedDraws makeParetoWeights(double shape) {
  const VectorXd at = makeMidpoints(400);
  const VectorXd weights = ((1.0 - at.array()).pow(-shape) - 1.0) / shape + 1.0;
  return weigh(MatrixXd::Zero(1, weights.size()), weights.array().log());
}

TEST(ParetoShape, AgreesWithTheReferenceImplementation) {
  // gpdfit() of R's package loo 2.6, written again with NumPy.
  EXPECT_NEAR(calcParetoShape(makeParetoWeights(0.3)), 0.33560832058231593, 1e-10);
  EXPECT_NEAR(calcParetoShape(makeParetoWeights(0.9)), 0.8183704168942175, 1e-10);
}

TEST(ParetoShape, BoundedWeightsHaveNone) {
  EXPECT_EQ(calcParetoShape(weigh(MatrixXd::Zero(1, 100), VectorXd::Zero(100))), 0.0);
  const VectorXd at = makeMidpoints(400);
  EXPECT_LT(calcParetoShape(weigh(at.transpose(), at.array().log())), 0.2);
}

TEST(ParetoShape, OneDrawThatBearsAllIsSeen) {
  VectorXd log_weights = makeMidpoints(400);
  log_weights *= 60.0;
  EXPECT_GT(calcParetoShape(weigh(MatrixXd::Zero(1, 400), log_weights)), 0.7);
}

TEST(ParetoShape, TooFewWeightsTellNothing) {
  EXPECT_TRUE(std::isnan(calcParetoShape(weigh(MatrixXd::Zero(1, 20), VectorXd::Zero(20)))));
}

}  // namespace
}  // namespace twinmap::importance
