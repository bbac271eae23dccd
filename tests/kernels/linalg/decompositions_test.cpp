// Each decomposition against its definition, and where it is small against numbers by hand.
#include "kernels/linalg/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "tests/kernels/support/random_data.hpp"

namespace twinmap::linalg {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

constexpr Index kSize = 40;
constexpr double kTolerance = 1e-11;  // rounding of n^2 operations on numbers of order n

MatrixXd makePositiveDefinite(Index n) {
  const MatrixXd x = randomMatrix(n, n + 5, 11);
  return x * x.transpose() + MatrixXd::Identity(n, n);
}

/// The lower triangle alone, and rubbish above it.
MatrixXd hideUpper(const MatrixXd& symmetric) {
  MatrixXd hidden = MatrixXd::Constant(symmetric.rows(), symmetric.cols(), 1e9);
  hidden.triangularView<Eigen::Lower>() = symmetric;
  return hidden;
}

TEST(SymmetricEigen, ByHand) {
  MatrixXd a(2, 2);
  a << 2, 1, 1, 2;
  const SymmetricEigen eigen = calcSymmetricEigen(a);
  EXPECT_NEAR(eigen.values[0], 1.0, 1e-15);
  EXPECT_NEAR(eigen.values[1], 3.0, 1e-15);
  EXPECT_NEAR(eigen.vectors(0, 1), eigen.vectors(1, 1), 1e-15);
  EXPECT_NEAR(eigen.vectors(0, 0), -eigen.vectors(1, 0), 1e-15);
}

TEST(SymmetricEigen, FulfilsItsDefinitionFromTheLowerTriangle) {
  const MatrixXd a = makePositiveDefinite(kSize) - 20.0 * MatrixXd::Identity(kSize, kSize);
  const SymmetricEigen eigen = calcSymmetricEigen(hideUpper(a));
  const MatrixXd& v = eigen.vectors;
  EXPECT_LT((v * eigen.values.asDiagonal() * v.transpose() - a).norm(), kTolerance);
  EXPECT_LT((v.transpose() * v - MatrixXd::Identity(kSize, kSize)).norm(), kTolerance);
  EXPECT_TRUE(std::is_sorted(eigen.values.begin(), eigen.values.end()));
  EXPECT_LT((calcSymmetricEigenvalues(hideUpper(a)) - eigen.values).norm(), kTolerance);
}

// The roots of x^3 - 6 x^2 + 13 x - 10 are 2 and 2 +- i.
TEST(Eigenvalues, OfACompanionMatrixAreTheRootsOfItsPolynomial) {
  MatrixXd companion(3, 3);
  companion << 6, -13, 10, 1, 0, 0, 0, 1, 0;
  const Eigen::VectorXcd values = calcEigenvalues(companion);
  for (const std::complex<double> root : {std::complex<double>(2, -1), {2, 0}, {2, 1}}) {
    EXPECT_LT((values.array() - root).abs().minCoeff(), 1e-13);
  }
}

TEST(CholeskyDecomposition, FactorAndSolutionsFulfilTheirDefinitions) {
  const MatrixXd a = makePositiveDefinite(kSize), b = randomMatrix(kSize, 7, 12);
  const Cholesky factor = calcCholesky(hideUpper(a));
  ASSERT_TRUE(factor.positive_definite);
  EXPECT_EQ(factor.lower, MatrixXd(factor.lower.triangularView<Eigen::Lower>()));
  EXPECT_LT((factor.lower * factor.lower.transpose() - a).norm(), kTolerance);
  EXPECT_LT((factor.lower * solveLower(factor.lower, b) - b).norm(), kTolerance);
  EXPECT_LT((a * solveCholesky(factor.lower, b) - b).norm(), kTolerance);
  EXPECT_LT((a * solvePositiveDefinite(hideUpper(a), b.col(0)) - b.col(0)).norm(), kTolerance);
  EXPECT_LT((a * invertPositiveDefinite(hideUpper(a)) - MatrixXd::Identity(a.rows(), a.cols())).norm(),
            kTolerance);
}

TEST(CholeskyDecomposition, KnowsItsCondition) {
  const VectorXd diagonal = (VectorXd(3) << 1.0, 1e3, 1e-5).finished();
  EXPECT_NEAR(calcCholesky(diagonal.asDiagonal()).reciprocal_condition, 1e-8, 1e-20);
}

TEST(CholeskyDecomposition, RefusesIndefiniteAndNotANumber) {
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    MatrixXd a = makePositiveDefinite(5);
    a(3, 3) = bad;
    const Cholesky factor = calcCholesky(a);
    EXPECT_FALSE(factor.positive_definite) << bad;
    EXPECT_EQ(factor.reciprocal_condition, 0.0) << bad;
  }
}

TEST(SolveSemidefinite, SolvesWithinTheRangeOfASingularMatrix) {
  const MatrixXd x = randomMatrix(6, 4, 13);
  const MatrixXd a = x * x.transpose(), b = a * randomMatrix(6, 3, 14);
  EXPECT_LT((a * solveSemidefinite(hideUpper(a), b) - b).norm(), 1e-10);
}

TEST(SolveLinear, ByHandAndByDefinition) {
  MatrixXd a(2, 2);
  a << 0, 2, 4, 1;
  EXPECT_LT((solveLinear(a, Eigen::Vector2d(6, 7)) - Eigen::Vector2d(1, 3)).norm(), 1e-15);
  const MatrixXd larger = randomMatrix(kSize, kSize, 15);
  const VectorXd b = randomMatrix(kSize, 1, 16);
  EXPECT_LT((larger * solveLinear(larger, b) - b).norm(), 1e-10);
}

TEST(LogDeterminant, ByHandAndOfProducts) {
  MatrixXd a(2, 2);
  a << 0, 2, 4, 1;  // -8
  EXPECT_NEAR(calcLogDeterminant(a).log_size, std::log(8.0), 1e-14);
  EXPECT_EQ(calcLogDeterminant(a).sign, -1.0);
  const MatrixXd b = randomMatrix(kSize, kSize, 19), c = randomMatrix(kSize, kSize, 20);
  const LogDeterminant of_b = calcLogDeterminant(b), of_c = calcLogDeterminant(c);
  const LogDeterminant of_both = calcLogDeterminant(b * c);
  EXPECT_NEAR(of_both.log_size, of_b.log_size + of_c.log_size, 1e-9);
  EXPECT_EQ(of_both.sign, of_b.sign * of_c.sign);
  EXPECT_EQ(calcLogDeterminant(MatrixXd::Zero(2, 2)).sign, 0.0);
}

TEST(LinearFit, LeavesAResidualOrthogonalToTheColumns) {
  const MatrixXd a = randomMatrix(30, 5, 17), b = randomMatrix(30, 2, 18);
  const LinearFit fit = fitLinear(a, b);
  EXPECT_EQ(fit.rank, 5);
  EXPECT_LT((a.transpose() * (a * fit.coefficients - b)).norm(), kTolerance);
  EXPECT_LT((solveMinimumNorm(a, b.col(0)) - fit.coefficients.col(0)).norm(), kTolerance);
}

// x + 2 y = 5 twice: the least of its solutions is a multiple of (1, 2).
TEST(LinearFit, OfDeficientRankHasTheLeastNorm) {
  MatrixXd a(2, 2);
  a << 1, 2, 1, 2;
  const VectorXd b = VectorXd::Constant(2, 5.0);
  const LinearFit fit = fitLinear(a, b);
  EXPECT_EQ(fit.rank, 1);
  EXPECT_LT((fit.coefficients - Eigen::Vector2d(1, 2)).norm(), 1e-14);
  EXPECT_LT((solveMinimumNorm(a, b) - Eigen::Vector2d(1, 2)).norm(), 1e-14);
}

// Loops whose coordinates are all held have equations and no unknown.
TEST(LinearFit, WithoutUnknownsOrEquationsHasTheLeastNorm) {
  EXPECT_EQ(solveMinimumNorm(MatrixXd(3, 0), VectorXd::Ones(3)).size(), 0);
  EXPECT_EQ(solveMinimumNorm(MatrixXd(0, 2), VectorXd()), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace twinmap::linalg
