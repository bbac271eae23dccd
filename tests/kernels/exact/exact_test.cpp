#include "kernels/exact/exact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/packed_lower.hpp"
#include "kernels/surrogate/slope_covariance.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

int size(const VectorXd& vector) {
  return static_cast<int>(vector.size());
}

MatrixXd makePositiveDefinite(Index n) {
  const MatrixXd root = randomMatrix(n, n + 3, static_cast<std::uint64_t>(n));
  return root * root.transpose() + 0.1 * MatrixXd::Identity(n, n);
}

TEST(Exact, DotIsTheSumForEveryCountOfLanes) {
  for (Index n : {0, 1, 7, 8, 9, 16, 23, 24, 100}) {
    const VectorXd a = randomMatrix(n, 1, 1), b = randomMatrix(n, 1, 2);
    long double sum = 0.0L;
    for (Index i = 0; i < n; ++i) {
      sum += static_cast<long double>(a(i)) * b(i);
    }
    EXPECT_NEAR(exact::dot(size(a), a.data(), b.data()), static_cast<double>(sum), 1e-14) << n;
  }
}

TEST(Exact, ALowerTriangleIsPackedColumnByColumn) {
  MatrixXd matrix(3, 3);
  matrix << 1, 9, 9, 2, 4, 9, 3, 5, 6;
  EXPECT_EQ(linalg::packColumns(matrix), (VectorXd(6) << 1, 2, 3, 4, 5, 6).finished());
}

TEST(Exact, PackedTrianglesAreSolved) {
  for (Index n : {1, 2, 5, 6, 31}) {
    const MatrixXd lower = linalg::calcCholesky(makePositiveDefinite(n)).lower;
    VectorXd x = randomMatrix(n, 1, 3);
    const VectorXd solved = linalg::solveLower(lower, x);
    exact::solveColumns(static_cast<int>(n), linalg::packColumns(lower).data(), x.data());
    EXPECT_LT((x - solved).cwiseAbs().maxCoeff(), 1e-11) << n;
  }
}

/// Derivatives of the first variables, at a point of five.
VectorXd calcSlopes(int variables) {
  const MatrixXd points = randomMatrix(21, 5, 6);
  const exact::smooth_process process =
      gp::describeProcess(gp::SmoothCovariance::kMatern52, 1e-8, points, 13, 5);
  gp::PointCovariance at;
  gp::calcPointCovariance(process, randomMatrix(5, 1, 7), at);
  const VectorXd weights = randomMatrix(21 + 5 * 13, 1, 8);
  (void)exact::calcFunction(process, weights.data(), at.getView());
  VectorXd rising(variables), slopes(variables);
  exact::calcFunctionSlopes(process, weights.data(), at.getView(), variables, rising.data(), slopes.data());
  return slopes;
}

TEST(Exact, BitsDoNotDependOnHowManyVariablesAreTakenAtOnce) {
  const VectorXd all = calcSlopes(5);
  for (int variables = 1; variables < 5; ++variables) {
    EXPECT_EQ(calcSlopes(variables), all.head(variables)) << variables;
  }
}

TEST(Exact, DerivativesAreThoseOfTheFunction) {
  const MatrixXd points = randomMatrix(21, 3, 6);
  const VectorXd weights = randomMatrix(21 + 2 * 9, 1, 8);
  for (const auto covariance : {gp::SmoothCovariance::kSquaredExponential, gp::SmoothCovariance::kMatern52}) {
    const exact::smooth_process process = gp::describeProcess(covariance, 1e-8, points, 9, 2);
    gp::PointCovariance at;
    const auto calc = [&](const VectorXd& point) {
      gp::calcPointCovariance(process, point, at);
      return exact::calcFunction(process, weights.data(), at.getView());
    };
    const VectorXd point = randomMatrix(3, 1, 7);
    VectorXd numeric(3), rising(3), slopes(3);
    for (Index v = 0; v < 3; ++v) {
      const VectorXd aside = 1e-5 * VectorXd::Unit(3, v);
      numeric(v) = (calc(point + aside) - calc(point - aside)) / 2e-5;
    }
    (void)calc(point);
    exact::calcFunctionSlopes(process, weights.data(), at.getView(), 3, rising.data(), slopes.data());
    EXPECT_LT((slopes - numeric).cwiseAbs().maxCoeff(), 1e-8);
  }
}

}  // namespace
}  // namespace twinmap
