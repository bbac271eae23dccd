#include "kernels/exact/exact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
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

/// Lower triangle, column by column.
VectorXd pack(const MatrixXd& lower) {
  const Index n = lower.rows();
  VectorXd packed(n * (n + 1) / 2);
  for (Index j = 0, at = 0; j < n; at += n - j, ++j) {
    packed.segment(at, n - j) = lower.col(j).tail(n - j);
  }
  return packed;
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

TEST(Exact, FactorsSolveAndDeterminantsAreThoseOfCholesky) {
  for (Index n : {1, 2, 5, 6, 31}) {
    const MatrixXd matrix = makePositiveDefinite(n);
    const MatrixXd expected = linalg::calcCholesky(matrix).lower;
    VectorXd factor = pack(matrix);
    exact::factorise(static_cast<int>(n), factor.data());
    EXPECT_LT((factor - pack(expected)).cwiseAbs().maxCoeff(), 1e-12) << n;
    VectorXd x = randomMatrix(n, 1, 3);
    const VectorXd solved = linalg::solveLower(expected, x);
    exact::solveColumns(static_cast<int>(n), factor.data(), x.data());
    EXPECT_LT((x - solved).cwiseAbs().maxCoeff(), 1e-11) << n;
    const double determinant = 2.0 * expected.diagonal().array().log().sum();
    EXPECT_NEAR(exact::calcLogDeterminant(static_cast<int>(n), factor.data()), determinant, 1e-11);
    MatrixXd room(n, n);
    EXPECT_NEAR(exact::calcSmallLogDeterminant(static_cast<int>(n), matrix.data(), room.data()), determinant,
                1e-11);
  }
}

TEST(Exact, AStepIsTheDampedOneUnderItsPrior) {
  const MatrixXd root = randomMatrix(3, 3, 6), relative = root * root.transpose();
  const VectorXd mean = (VectorXd(3) << 0.1, 0.3, -0.2).finished();
  const MatrixXd jacobian = randomMatrix(20, 3, 4);
  MatrixXd information(3, 3), room(3, 3);
  exact::calcInformation(20, 3, jacobian.data(), information.data());
  EXPECT_LT((information - jacobian.transpose() * jacobian).cwiseAbs().maxCoeff(), 1e-13);
  const VectorXd unknown = (VectorXd(3) << 0.2, -0.7, 0.4).finished(), gradient = randomMatrix(3, 1, 5);
  VectorXd step = gradient, offset(3), pull(3);
  exact::calcPull(3, relative.data(), mean.data(), unknown.data(), offset.data(), pull.data());
  EXPECT_LT((pull - relative * (unknown - mean)).cwiseAbs().maxCoeff(), 1e-14);
  ASSERT_TRUE(
      exact::solveStep(3, information.data(), relative.data(), pull.data(), 0.5, room.data(), step.data()));
  MatrixXd damped = information;
  damped.diagonal() *= 1.5;
  damped += 3.0 * relative;
  EXPECT_LT((step - linalg::solvePositiveDefinite(damped, gradient - 3.0 * pull)).cwiseAbs().maxCoeff(),
            1e-13);
}

TEST(Exact, TheBoxPullsWithTheUnknownsThemselves) {
  const MatrixXd box = MatrixXd::Identity(3, 3);
  const VectorXd middle = VectorXd::Zero(3), unknown = randomMatrix(3, 1, 7);
  VectorXd offset(3), pull(3);
  exact::calcPull(3, box.data(), middle.data(), unknown.data(), offset.data(), pull.data());
  EXPECT_EQ(pull, unknown);
}

TEST(Exact, AStepWithoutPositiveInformationIsRefused) {
  const MatrixXd information = -10.0 * MatrixXd::Identity(2, 2);
  const MatrixXd box = MatrixXd::Identity(2, 2);
  const VectorXd pull = VectorXd::Zero(2);
  MatrixXd room(2, 2);
  VectorXd step = VectorXd::Ones(2);
  EXPECT_FALSE(
      exact::solveStep(2, information.data(), box.data(), pull.data(), 0.0, room.data(), step.data()));
}

TEST(Exact, ErrorsAreEnlargedToTheResidualsOnlyWhereTheseAreBeyondThem) {
  const VectorXd stddev = VectorXd::Constant(8, 2.0), scores = VectorXd::Zero(8);
  const VectorXd near = VectorXd::Constant(8, 2.0), far = VectorXd::Constant(8, 21.0);
  EXPECT_EQ(exact::calcWidening(8, stddev.data(), scores.data(), near.data()), 0.0);
  // squares 441 each: (441 - 1) / 4 = 110
  EXPECT_NEAR(exact::calcWidening(8, stddev.data(), scores.data(), far.data()), std::sqrt(110.0), 1e-12);
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
