#include "framework/estimation/log_coordinates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using testing::makeVector;

/// A stiffness, an offset of either sign, and a number that is negative.
std::vector<ParameterSpec> makeMixed() {
  std::vector<ParameterSpec> parameters = testing::makeParameters(3, 2.0, 50.0);
  parameters[1].bounds = {-0.3, 0.1, {}};
  parameters[2].bounds = {-8.0, -2.0, {}};
  return parameters;
}

TEST(LogCoordinates, AreLogarithmsWhereBoundsHaveOneSign) {
  const LogCoordinates coordinates(makeMixed());
  const VectorXd box = coordinates.toBox(makeVector({0.0, 0.4, 0.0}));
  EXPECT_NEAR(26.0 + 24.0 * box[0], std::sqrt(2.0 * 50.0), 1e-12);  // the middle is the geometric mean
  EXPECT_EQ(box[1], 0.4);
  EXPECT_NEAR(-5.0 + 3.0 * box[2], -std::sqrt(8.0 * 2.0), 1e-12);
}

TEST(LogCoordinates, KeepTheBounds) {
  const LogCoordinates coordinates(makeMixed());
  EXPECT_LT((coordinates.toBox(VectorXd::Ones(3)) - VectorXd::Ones(3)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((coordinates.toBox(-VectorXd::Ones(3)) + VectorXd::Ones(3)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LogCoordinates, GoBackToWhereTheyCameFrom) {
  const LogCoordinates coordinates(makeMixed());
  for (const double x : {-0.99, -0.3, 0.0, 0.7, 1.0}) {
    const VectorXd at = makeVector({x, -x, 0.5 * x});
    EXPECT_LT((coordinates.fromBox(coordinates.toBox(at)) - at).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(LogCoordinates, SlopesAreDifferencesAndTheirProductIsTheDensityOfUniform) {
  const LogCoordinates coordinates(makeMixed());
  constexpr double kStep = 1e-6;
  const VectorXd at = makeVector({0.4, 0.1, -0.6}), origin = VectorXd::Zero(3);
  const VectorXd slopes = coordinates.calcSlopes(at);
  for (Index j = 0; j < 3; ++j) {
    const VectorXd step = kStep * VectorXd::Unit(3, j);
    const VectorXd rise = coordinates.toBox(at + step) - coordinates.toBox(at - step);
    EXPECT_NEAR(slopes[j], rise[j] / (2.0 * kStep), 1e-8);
    EXPECT_GT(slopes[j], 0.0);
  }
  const double expected = slopes.array().log().sum() - coordinates.calcSlopes(origin).array().log().sum();
  EXPECT_NEAR(coordinates.calcLogUniform(at) - coordinates.calcLogUniform(origin), expected, 1e-12);
}

}  // namespace
}  // namespace twinmap
