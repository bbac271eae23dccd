#include "kernels/optimization/box_quadratic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/kernels/support/random_data.hpp"

namespace twinmap::optimization {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

MatrixXd makeCurvature(Index n, unsigned seed) {
  const MatrixXd factor = test::randomMatrix(static_cast<int>(n), static_cast<int>(n), seed);
  return factor * factor.transpose() + 1e-4 * MatrixXd::Identity(n, n);
}

TEST(MinimizeQuadratic, TakesNewtonsStepInsideTheBox) {
  const MatrixXd curvature = (MatrixXd(2, 2) << 2.0, 1.0, 1.0, 3.0).finished();
  const VectorXd step =
      minimizeQuadratic(curvature, Vector2d(-4.0, -7.0), Vector2d(-9.0, -9.0), Vector2d(9.0, 9.0));
  EXPECT_NEAR(step(0), 1.0, 1e-14);
  EXPECT_NEAR(step(1), 2.0, 1e-14);
}

// Newton's step (9, -10) crosses both bounds. Where both stay at them, the slope of the first points inwards.
TEST(MinimizeQuadratic, ReleasesABoundWhoseSlopeTurns) {
  const MatrixXd curvature = (MatrixXd(2, 2) << 1.0, 0.9, 0.9, 1.0).finished();
  const Vector2d gradient = -curvature * Vector2d(9.0, -10.0);
  const VectorXd step = minimizeQuadratic(curvature, gradient, Vector2d(-1.0, -1.0), Vector2d(3.0, 3.0));
  EXPECT_EQ(step(1), -1.0);
  EXPECT_NEAR(step(0), std::clamp(-(gradient(0) - 0.9), -1.0, 3.0), 1e-14);
}

// The conditions of Karush, Kuhn and Tucker, which a convex quadratic meets at its minimum alone.
TEST(MinimizeQuadratic, MeetsTheConditionsOfAMinimum) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Index n = 1 + seed % 9;
    const MatrixXd curvature = makeCurvature(n, seed);
    const VectorXd gradient = test::randomMatrix(static_cast<int>(n), 1, seed + 1000);
    const VectorXd lower = -test::randomMatrix(static_cast<int>(n), 1, seed + 2000).cwiseAbs();
    VectorXd upper = test::randomMatrix(static_cast<int>(n), 1, seed + 3000).cwiseAbs();
    upper(0) = 0.0;
    const VectorXd step = minimizeQuadratic(curvature, gradient, lower, upper);
    const VectorXd slope = gradient + curvature * step;
    for (Index i = 0; i < n; ++i) {
      EXPECT_GE(step(i), lower(i)) << seed;
      EXPECT_LE(step(i), upper(i)) << seed;
      const double inwards = step(i) == lower(i)   ? -slope(i)
                             : step(i) == upper(i) ? slope(i)
                                                   : std::abs(slope(i));
      EXPECT_LT(inwards, 1e-9) << seed << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace twinmap::optimization
