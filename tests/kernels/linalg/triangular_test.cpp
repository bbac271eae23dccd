#include "kernels/linalg/triangular.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kernels/linalg/condition.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/packed_lower.hpp"
#include "tests/kernels/support/random_data.hpp"
#include "tests/lu.hpp"

namespace twinmap::linalg {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

MatrixXd positiveDefinite(Index n) {
  const MatrixXd x = randomMatrix(n, n + 3, 7 + n);
  return x * x.transpose() / double(n) + 0.1 * MatrixXd::Identity(n, n);
}

MatrixXd lowerPart(const MatrixXd& matrix) {
  return matrix.triangularView<Eigen::Lower>();
}

// Rounding: n operations an element, numbers of order one.
double tolerance(Index n) {
  return 50.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
}

TEST(Gemm, MultipliesAHandSizedCase) {
  MatrixXd a(2, 2), b(2, 2), c(2, 2);
  a << 1, 2, 3, 4;
  b << 5, 6, 7, 8;
  c << 1, 1, 1, 1;
  GemmScratch scratch;
  gemm(2.0, viewOf(a), viewOf(b), 1.0, viewOf(c), scratch);
  MatrixXd expected(2, 2);
  expected << 39, 45, 87, 101;
  EXPECT_EQ(c, expected);
}

class GemmSizes : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(GemmSizes, AgreesWithEigenForEveryTransposition) {
  const auto [m, n, k] = GetParam();
  const MatrixXd a = randomMatrix(m, k, 1), b = randomMatrix(k, n, 2), at = a.transpose(), bt = b.transpose();
  const MatrixXd expected = a * b;
  GemmScratch scratch;
  for (const ConstView left : {viewOf(a), viewOf(at).transposed()}) {
    for (const ConstView right : {viewOf(b), viewOf(bt).transposed()}) {
      MatrixXd c = MatrixXd::Constant(m, n, std::numeric_limits<double>::quiet_NaN());
      gemm(1.0, left, right, 0.0, viewOf(c), scratch);
      EXPECT_LT((c - expected).cwiseAbs().maxCoeff(), tolerance(k));
      gemm(-0.5, left, right, 1.0, viewOf(c), scratch);
      EXPECT_LT((c - 0.5 * expected).cwiseAbs().maxCoeff(), tolerance(k));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, GemmSizes,
                         testing::Values(std::array{1, 1, 1}, std::array{5, 3, 2}, std::array{16, 8, 4},
                                         std::array{33, 47, 65}, std::array{250, 31, 300},
                                         std::array{17, 1050, 9}, std::array{410, 40, 520}));

class Triangular : public testing::TestWithParam<int> {};

TEST_P(Triangular, FactorInverseAndProductFulfilTheirDefinitions) {
  const Index n = GetParam();
  const MatrixXd k = positiveDefinite(n);
  TriangularScratch scratch(n);
  MatrixXd factor = k;
  ASSERT_TRUE(factorizeCholesky(viewOf(factor), scratch));
  const MatrixXd lower = lowerPart(factor);
  EXPECT_LT((lower * lower.transpose() - k).norm() / k.norm(), tolerance(n));
  MatrixXd inverse = lower;
  invertLower(viewOf(inverse), scratch);
  EXPECT_EQ(inverse, lowerPart(inverse)) << "zeros above the diagonal";
  EXPECT_LT((inverse * lower - MatrixXd::Identity(n, n)).norm(), 100 * tolerance(n));
  MatrixXd product = inverse;
  multiplyTransposedBySelf(viewOf(product), scratch);
  const MatrixXd expected = inverse.transpose() * inverse;
  EXPECT_LT(lowerPart(product - expected).norm() / expected.norm(), tolerance(n));
}

TEST_P(Triangular, SolvesAgreeWithTheFactor) {
  const Index n = GetParam();
  MatrixXd factor = positiveDefinite(n);
  TriangularScratch scratch(n);
  ASSERT_TRUE(factorizeCholesky(viewOf(factor), scratch));
  const MatrixXd lower = lowerPart(factor);
  const VectorXd x = randomMatrix(n, 1, 3);
  VectorXd forward = x, backward = x;
  solveLower(viewOf(lower), forward.data());
  solveLowerTransposed(viewOf(lower), backward.data());
  EXPECT_LT((lower * forward - x).norm(), tolerance(n));
  EXPECT_LT((lower.transpose() * backward - x).norm(), tolerance(n));
  MatrixXd right = randomMatrix(37, n, 4);
  const MatrixXd b = right;
  solveTransposedFromRight(viewOf(lower), viewOf(right), scratch);
  EXPECT_LT((right * lower.transpose() - b).norm(), 10 * tolerance(n));
  const PackedLower packed(viewOf(lower));
  VectorXd padded_x = VectorXd::Zero(packed.paddedSize());
  padded_x.head(n) = x;
  packed.solve(padded_x.data());
  EXPECT_LT((padded_x.head(n) - forward).norm(), 10 * tolerance(n));
  EXPECT_EQ(padded_x.tail(packed.paddedSize() - n).norm(), 0.0);
  MatrixXd many = MatrixXd::Zero(packed.paddedSize(), 3);
  many.col(1).head(n) = x;
  many.col(2).head(n) = 2.0 * x;
  packed.solve(many);
  EXPECT_EQ(many.col(0).norm(), 0.0);
  EXPECT_EQ(many.col(1), padded_x);
  EXPECT_EQ(many.col(2), 2.0 * padded_x);
}

TEST_P(Triangular, ConditionEstimateLiesWithinAFactorOfTheTruth) {
  const Index n = GetParam();
  const MatrixXd k = positiveDefinite(n);
  const MatrixXd lower = calcCholesky(k).lower;
  const double truth =
      k.cwiseAbs().colwise().sum().maxCoeff() * test::calcInverse(k).cwiseAbs().colwise().sum().maxCoeff();
  const double estimate = estimateCondition(viewOf(lower));
  EXPECT_GT(estimate, truth / 3.0);
  EXPECT_LT(estimate, truth * static_cast<double>(n) + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Orders, Triangular, testing::Values(1, 2, 5, 31, 32, 33, 64, 100, 129, 250, 391));

TEST(Cholesky, RefusesIndefiniteAndNotANumber) {
  TriangularScratch scratch(4);
  MatrixXd indefinite = -MatrixXd::Identity(3, 3);
  EXPECT_FALSE(factorizeCholesky(viewOf(indefinite), scratch));
  MatrixXd not_a_number = MatrixXd::Identity(3, 3);
  not_a_number(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(factorizeCholesky(viewOf(not_a_number), scratch));
}

TEST(Cholesky, FactorizesAHandSizedCase) {
  MatrixXd k(3, 3);
  k << 4, 0, 0, 12, 37, 0, -16, -43, 98;
  TriangularScratch scratch(3);
  ASSERT_TRUE(factorizeCholesky(viewOf(k), scratch));
  MatrixXd expected(3, 3);
  expected << 2, 0, 0, 6, 1, 0, -8, 5, 3;
  EXPECT_LT((lowerPart(k) - expected).norm(), 1e-13);
}

}  // namespace
}  // namespace twinmap::linalg
