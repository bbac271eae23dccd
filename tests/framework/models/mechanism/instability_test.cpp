#include "framework/models/mechanism/lanes/instability.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Eigen::MatrixXd;

/// Of z'' = S z + D z'.
MatrixXd makeMatrix(const Eigen::Matrix2d& stiffness, const Eigen::Matrix2d& damping) {
  MatrixXd matrix = MatrixXd::Zero(4, 4);
  matrix.topRightCorner(2, 2).setIdentity();
  matrix.bottomLeftCorner(2, 2) = stiffness;
  matrix.bottomRightCorner(2, 2) = damping;
  return matrix;
}

TEST(FindInstability, SaysNothingOfWhatDecaysOrStays) {
  const Eigen::Matrix2d spring = Eigen::Vector2d(-100.0, -4.0).asDiagonal();
  EXPECT_FALSE(findInstability(makeMatrix(spring, -0.1 * Eigen::Matrix2d::Identity()), 2));
  EXPECT_FALSE(findInstability(makeMatrix(spring, Eigen::Matrix2d::Zero()), 2));
  EXPECT_FALSE(findInstability(makeMatrix(Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()), 2));
  EXPECT_FALSE(findInstability(MatrixXd(), 0));
}

TEST(FindInstability, NamesTheCoordinateOfANegativeSpring) {
  const Eigen::Matrix2d spring = Eigen::Vector2d(-100.0, 4.0).asDiagonal();
  const auto found = findInstability(makeMatrix(spring, Eigen::Matrix2d::Zero()), 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rate, 2.0, 1e-9);
  EXPECT_EQ(found->coordinate, 1);
  EXPECT_EQ(found->cause, GrowthCause::kStiffness);
}

TEST(FindInstability, NamesANegativeDamper) {
  const Eigen::Matrix2d spring = Eigen::Vector2d(-100.0, -4.0).asDiagonal(),
                        damper = Eigen::Vector2d(0.6, -0.1).asDiagonal();
  const auto found = findInstability(makeMatrix(spring, damper), 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rate, 0.3, 1e-9);
  EXPECT_EQ(found->coordinate, 0);
  EXPECT_EQ(found->cause, GrowthCause::kDamping);
}

TEST(FindInstability, TellsCoordinatesThatDriveEachOther) {
  Eigen::Matrix2d follower;  // a load that turns with the beam: S is not symmetric
  follower << -4.0, -3.0, 3.0, -4.0;
  const auto found = findInstability(makeMatrix(follower, Eigen::Matrix2d::Zero()), 2);
  ASSERT_TRUE(found);
  // lambda^2 = -4 +- 3i: |lambda|^2 = 5, so that the real part is sqrt((5 - 4) / 2)
  EXPECT_NEAR(found->rate, std::sqrt(0.5), 1e-9);
  EXPECT_EQ(found->cause, GrowthCause::kCoupling);
}

}  // namespace
}  // namespace twinmap
