#include "kernels/linalg/paired_matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/kernels/support/random_data.hpp"

namespace twinmap::linalg {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

TEST(RoundToHalves, KeepsTwentyOneBits) {
  const MatrixXd matrix = randomMatrix(40, 50, 3);
  const MatrixXd rounded = roundToHalves(matrix);
  EXPECT_LE(((rounded - matrix).array() / matrix.array()).abs().maxCoeff(), std::ldexp(1.0, -21));
  EXPECT_EQ(roundToHalves(rounded), rounded);
  EXPECT_EQ(roundToHalves(-matrix), -rounded);
  MatrixXd known(1, 4);
  known << 0.0, -3.0, 1.0 + std::ldexp(1.0, -20), 1.0 + std::ldexp(1.0, -22);
  MatrixXd expected = known;
  expected(3) = 1.0;
  EXPECT_EQ(roundToHalves(known), expected);
}

TEST(PairedMatrix, MultipliesAsTheRoundedMatrixDoes) {
  for (const Index rows : {1, 4, 7, 8, 9, 16, 17, 31, 32, 33, 48, 63, 64, 65, 100, 192}) {
    for (const Index cols : {1, 2, 3, 4, 7, 64}) {
      const MatrixXd matrix = randomMatrix(rows, cols, 5);
      const VectorXd vector = randomMatrix(cols, 1, 6);
      const PairedMatrix paired(matrix);
      ASSERT_EQ(paired.rows(), rows);
      ASSERT_EQ(paired.cols(), cols);
      VectorXd product = VectorXd::Constant(rows + 1, 7.0);
      paired.multiply(vector.data(), product.data());
      EXPECT_LT((product.head(rows) - roundToHalves(matrix) * vector).norm(), 1e-14 * matrix.norm())
          << rows << " x " << cols;
      EXPECT_EQ(product[rows], 7.0) << "written beyond the rows";
    }
  }
}

TEST(PairedMatrix, OfNothingGivesNothing) {
  VectorXd product = VectorXd::Constant(3, 7.0);
  PairedMatrix(MatrixXd(0, 3)).multiply(product.data(), product.data());
  EXPECT_EQ(product, VectorXd::Constant(3, 7.0));
  PairedMatrix(MatrixXd(2, 0)).multiply(product.data(), product.data());
  EXPECT_EQ(product, Eigen::Vector3d(0.0, 0.0, 7.0));
}

TEST(PairedMatrix, PassesOnWhatIsNoNumber) {
  MatrixXd matrix = MatrixXd::Ones(3, 2);
  matrix(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const VectorXd ones = VectorXd::Ones(2);
  VectorXd product(3);
  PairedMatrix(matrix).multiply(ones.data(), product.data());
  EXPECT_EQ(product[0], 2.0);
  EXPECT_TRUE(std::isnan(product[1]));
}

}  // namespace
}  // namespace twinmap::linalg
