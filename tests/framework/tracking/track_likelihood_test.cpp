#include "framework/tracking/track_likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/tracking/modes.hpp"
#include "tests/framework/support/linear_simulator.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;

struct Setting {
  std::vector<ParameterSpec> parameters = testing::makeParameters(2, -10.0, 10.0);
  TrackSpace space{parameters};
  TrackPrior prior{{Eigen::VectorXd::Zero(2), MatrixXd::Identity(2, 2) / 3.0}, {}};
};

Estimate makeEstimate(const Vector2d& mean, const Matrix2d& covariance) {
  Estimate estimate{mean, covariance.diagonal().cwiseSqrt()};
  estimate.correlation = calcCorrelation(covariance);
  return estimate;
}

TEST(Likelihood, WithThePriorAgainIsThePosterior) {
  const Setting setting;
  Matrix2d covariance;
  covariance << 4.0, 1.5, 1.5, 2.0;  // half-widths are 10: a posterior that the prior matters to
  const Vector2d mean(3.0, -2.0);
  const tracking::Measurement said =
      makeTrackMeasurement(makeEstimate(mean, covariance), setting.space, setting.prior);
  const MatrixXd information =
      said.rows.transpose() * said.rows + test::calcInverse(setting.prior.belief.covariance);
  const MatrixXd posterior = test::calcInverse(information);
  EXPECT_LT((100.0 * posterior - covariance).norm(), 1e-9);
  EXPECT_LT((10.0 * posterior * said.rows.transpose() * said.values - mean).norm(), 1e-9);
}

/// A normal likelihood of two parameters that the bounds of the first cut off; moments by a grid of it.
TEST(Likelihood, OfAUniformPriorIsWhatTheBoundsCutOff) {
  Setting setting;
  setting.prior.uniform = {0, 1};
  const Vector2d mean(0.7, 0.1);  // half-widths
  const Matrix2d covariance = (Matrix2d() << 0.25, 0.02, 0.02, 0.0025).finished();
  const double slope = covariance(1, 0) / covariance(0, 0);
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    const double x = -1.0 + 1e-4 * i, off = x - mean[0];
    const double density = std::exp(-0.5 * off * off / covariance(0, 0)) * (i == 0 || i == 20000 ? 0.5 : 1.0);
    sum += density;
    first += density * x;
    second += density * x * x;
  }
  first /= sum;
  const double variance = second / sum - first * first;
  const double rest = covariance(1, 1) - slope * covariance(0, 1);  // of the second, given the first
  const Vector2d cut_mean(first, mean[1] + slope * (first - mean[0]));
  const Matrix2d cut =
      (Matrix2d() << variance, slope * variance, slope * variance, rest + slope * slope * variance)
          .finished();
  const tracking::Measurement said =
      makeTrackMeasurement(makeEstimate(10.0 * cut_mean, 100.0 * cut), setting.space, setting.prior);
  ASSERT_EQ(said.rows.rows(), 2);
  const MatrixXd found = test::calcInverse(said.rows.transpose() * said.rows);
  EXPECT_LT((found - covariance).norm(), 1e-4);
  EXPECT_LT((found * said.rows.transpose() * said.values - mean).norm(), 1e-4);
  Estimate refined = makeEstimate(10.0 * cut_mean, 100.0 * cut);
  refined.method = EstimationMethod::kRefined;  // its prior is normal
  const tracking::Measurement normal = makeTrackMeasurement(refined, setting.space, setting.prior);
  const MatrixXd information = normal.rows.transpose() * normal.rows + 3.0 * Matrix2d::Identity();
  EXPECT_LT((test::calcInverse(information) - cut).norm(), 1e-9);
}

TEST(Likelihood, HasNoRowWhereNothingIsSaid) {
  const Setting setting;
  const Matrix2d covariance = Vector2d(0.01, 100.0 / 3.0).asDiagonal();
  const tracking::Measurement said =
      makeTrackMeasurement(makeEstimate({1.0, 0.0}, covariance), setting.space, setting.prior);
  EXPECT_EQ(said.rows.rows(), 1);
  EXPECT_TRUE(std::isfinite(said.variances[0]));
  EXPECT_FALSE(std::isfinite(said.variances[1]));
}

TEST(Likelihood, OfDrawsThatBendHasModesAlongThem) {
  const Setting setting;
  Estimate estimate;
  estimate.draws.points.resize(2, 4000);
  estimate.draws.weights = Eigen::VectorXd::Constant(4000, 1.0 / 4000);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < 4000; ++i) {
    const double x = 3.0 * normal(random);
    estimate.draws.points.col(i) << x, 0.1 * x * x + 0.1 * normal(random);
  }
  estimate.mean = estimate.draws.points.rowwise().mean();
  estimate.stddev = Vector2d(3.0, 1.3);
  estimate.correlation = Matrix2d::Identity();
  const tracking::Measurement said = makeTrackMeasurement(estimate, setting.space, setting.prior);
  EXPECT_EQ(said.modes.size(), 8U);
  // where x is known to be 3, the other is known to be near .9
  tracking::Model model;
  model.drifts.resize(2);
  tracking::Belief belief{Vector2d(0.3, 0.0), Vector2d(1e-4, 1.0 / 3.0).asDiagonal()};
  const tracking::Measurement resolved = resolveModes(model, said, {}, belief);
  update({resolved.rows.transpose(), resolved.values}, belief);
  EXPECT_NEAR(10.0 * belief.mean[1], 0.9, 0.5);
  EXPECT_LT(10.0 * std::sqrt(belief.covariance(1, 1)), 0.6);
  for (Eigen::Index i = 0; i < 4000; ++i) {
    estimate.draws.points(1, i) = 0.1 * normal(random);
  }
  EXPECT_TRUE(makeTrackMeasurement(estimate, setting.space, setting.prior).modes.empty());
}

TEST(Likelihood, OfLogarithmsIsOfThem) {
  ParameterSpec parameter;
  parameter.bounds = {0.1, 10.0, {}};
  parameter.prior.emplace();
  parameter.prior->kind = LogUniformPrior{};
  const TrackSpace space({parameter});
  EXPECT_NEAR(space.toCoordinate(0, 1.0), 0.0, 1e-12);
  EXPECT_NEAR(space.toValue(0, 1.0), 10.0, 1e-12);
  EXPECT_NEAR(space.calcSlope(0, 1.0), 1.0 / std::log(10.0), 1e-12);
}

}  // namespace
}  // namespace twinmap
