#include "framework/data/features/noise_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/noise/noise_whitener.hpp"

namespace twinmap {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

Matrix3d makeCoupled() {
  return (Matrix3d() << 4.0, 1.0, 0.0, 1.0, 9.0, 2.0, 0.0, 2.0, 16.0).finished();
}

TEST(NoiseCovariance, OfIndependentNoiseIsItsVariances) {
  const Vector3d variances(4.0, 9.0, 16.0);
  const NoiseCovariance independent = NoiseCovariance::makeIndependent(variances);
  const NoiseCovariance same = MatrixXd(variances.asDiagonal());
  EXPECT_TRUE(independent.isDiagonal() && same.isDiagonal());
  EXPECT_EQ(independent.toMatrix(), same.toMatrix());
  EXPECT_EQ(independent.take({0, 2}).diagonal(), Eigen::Vector2d(4.0, 16.0));
  EXPECT_EQ(independent.col(1), Vector3d(0.0, 9.0, 0.0));
}

TEST(NoiseCovariance, TakesOtherStandardDeviationsWhereTheyAreStated) {
  const Vector3d stated(std::nan(""), 0.5, std::nan(""));
  Matrix3d expected = makeCoupled();
  expected.row(1).setZero();
  expected.col(1).setZero();
  expected(1, 1) = 0.25;
  EXPECT_EQ(NoiseCovariance(makeCoupled()).replace(stated).toMatrix(), expected);
  EXPECT_TRUE(NoiseCovariance(makeCoupled()).replace(stated).isDiagonal());  // no other pair was coupled
  EXPECT_EQ(NoiseCovariance::makeIndependent(Vector3d(4.0, 9.0, 16.0)).replace(stated).diagonal(),
            Vector3d(4.0, 0.25, 16.0));
}

TEST(NoiseCovariance, ActsAsItsMatrixWhateverItStores) {
  const MatrixXd right = MatrixXd::Random(3, 2);
  for (const MatrixXd& matrix : {MatrixXd(makeCoupled()), MatrixXd(makeCoupled().diagonal().asDiagonal())}) {
    const NoiseCovariance covariance = matrix;
    EXPECT_LT((covariance * right - matrix * right).norm(), 1e-14);
    EXPECT_EQ(covariance.take({1, 2}).toMatrix(), matrix.bottomRightCorner(2, 2));
    const NoiseWhitener noise(covariance);
    EXPECT_LT((noise.apply(matrix * noise.makeMatrix().transpose()) - MatrixXd::Identity(3, 3)).norm(),
              1e-14);
    EXPECT_LT((noise.applyTransposed(right) - noise.makeMatrix().transpose() * right).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace twinmap
