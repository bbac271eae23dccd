#include "framework/tracking/track_likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/tracking/belief.hpp"
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
  NormalBelief prior{Eigen::VectorXd::Zero(2), MatrixXd::Identity(2, 2) / 3.0};
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
      makeTrackMeasurement(makeEstimate(mean, covariance), setting.space, setting.prior, setting.prior);
  const MatrixXd information =
      said.rows.transpose() * said.rows + test::calcInverse(setting.prior.covariance);
  const MatrixXd posterior = test::calcInverse(information);
  EXPECT_LT((100.0 * posterior - covariance).norm(), 1e-9);
  EXPECT_LT((10.0 * posterior * said.rows.transpose() * said.values - mean).norm(), 1e-9);
}

TEST(Likelihood, HasNoRowWhereNothingIsSaid) {
  const Setting setting;
  const Matrix2d covariance = Vector2d(0.01, 100.0 / 3.0).asDiagonal();
  const tracking::Measurement said =
      makeTrackMeasurement(makeEstimate({1.0, 0.0}, covariance), setting.space, setting.prior, setting.prior);
  EXPECT_EQ(said.rows.rows(), 1);
  EXPECT_TRUE(std::isfinite(said.variances[0]));
  EXPECT_FALSE(std::isfinite(said.variances[1]));
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
