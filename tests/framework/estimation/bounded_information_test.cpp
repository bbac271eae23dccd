#include "framework/estimation/bounded_information.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const MatrixXd kMeasured = (MatrixXd(2, 2) << 10.0, 2.0, 2.0, 4.0).finished();
const MatrixXd kWhole = (MatrixXd(2, 2) << 13.0, 2.0, 2.0, 7.0).finished();  // a uniform box has 3

TEST(BoundedInformation, AddsThatOfTheBoundsAndInvertsTheSum) {
  const BoundedInformation information(kMeasured);
  const MatrixXd covariance = test::calcInverse(kWhole);
  EXPECT_LT((information.calcCovariance() - covariance).norm(), 1e-15);
  EXPECT_LT((information.getLower() * information.getLower().transpose() - kWhole).norm(), 1e-14);
  const VectorXd descent = Eigen::Vector2d(1.0, -2.0);
  EXPECT_LT((information.solve(descent) - covariance * descent).norm(), 1e-15);
  EXPECT_NEAR(information.calcLogDeterminant(), std::log(test::calcDeterminant(kWhole)), 1e-14);
}

TEST(BoundedInformation, OfDerivativesCountsThemByHalfWidth) {
  const MatrixXd jacobian = (MatrixXd(3, 2) << 1.0, 0.0, 2.0, -1.0, 0.0, 4.0).finished();
  const VectorXd half_widths = Eigen::Vector2d(0.5, 3.0);
  const MatrixXd scaled = jacobian * half_widths.asDiagonal();
  const MatrixXd whole = scaled.transpose() * scaled + 3.0 * MatrixXd::Identity(2, 2);
  EXPECT_LT((BoundedInformation(jacobian, half_widths).calcCovariance() - test::calcInverse(whole)).norm(),
            1e-15);
}

TEST(BoundedInformation, KeepsTheWidthOfTheBoundsWhereNothingIsMeasured) {
  const BoundedInformation nothing(MatrixXd::Zero(2, 2));
  EXPECT_LT((nothing.calcCovariance() - MatrixXd::Identity(2, 2) / 3.0).norm(), 1e-15);
  EXPECT_EQ(nothing.countDetermined(), 0.0);
}

TEST(BoundedInformation, CountsWhatTheMeasurementsDetermine) {
  // each coordinate I / (I + 3) of one: all of the first, half of the second, none of the third
  const BoundedInformation information(Eigen::Vector3d(1e12, 3.0, 0.0).asDiagonal().toDenseMatrix());
  EXPECT_NEAR(information.countDetermined(), 1.5, 1e-10);
  EXPECT_NEAR(calcDegrees(10, information), 8.5, 1e-10);
  EXPECT_EQ(calcDegrees(2, information), 1.0);  // at least one
}

}  // namespace
}  // namespace twinmap
