#include "framework/estimation/trained/anomaly.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::VectorXd;

TEST(Anomaly, ASpikeIsASingleResidual) {
  VectorXd residual = VectorXd::Constant(16, 0.5);
  residual[9] = -6.0;
  const Anomaly anomaly = findAnomaly(residual, {{0, 8}, {8, 8}});
  EXPECT_EQ(anomaly.first, 9);
  EXPECT_EQ(anomaly.count, 1);
  // P(chi square with 1 degree of freedom > 36) = 2e-9: 5.9 standard deviations; Wilson and Hilferty's
  // approximation is rough for a single degree of freedom.
  EXPECT_NEAR(anomaly.score, 5.9, 0.8);
}

TEST(Anomaly, ADisturbanceThatLastsIsFoundWhereNoSingleResidualStandsOut) {
  VectorXd residual = VectorXd::Constant(64, 0.6);
  residual.segment(16, 16).setConstant(2.2);
  const Anomaly anomaly = findAnomaly(residual, {{0, 64}});
  EXPECT_EQ(anomaly.first, 16);
  EXPECT_EQ(anomaly.count, 16);
  // Chi square 77.4 with 16 degrees of freedom: P = 5e-10, 6.1 standard deviations.
  EXPECT_NEAR(anomaly.score, 6.1, 0.2);
}

TEST(Anomaly, DoesNotReachFromOneRunIntoTheNext) {
  VectorXd residual = VectorXd::Zero(8);
  residual.segment(3, 2).setConstant(3.0);
  EXPECT_EQ(findAnomaly(residual, {{0, 8}}).count, 2);
  EXPECT_EQ(findAnomaly(residual, {{0, 4}, {4, 4}}).count, 1);
}

}  // namespace
}  // namespace twinmap
