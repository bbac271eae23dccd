#include "kernels/interpolation/interpolator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;

/// Three functions of two variables, one of them of a far larger size.
MatrixXd calcFunctions(const MatrixXd& points) {
  MatrixXd values(3, points.cols());
  values.row(0) = 1000.0 * (2.0 * points.row(0) + points.row(1)).array().sin();
  values.row(1) = points.row(0).array() * points.row(1).array();
  values.row(2) = (points.row(1).array()).exp() + 5.0;
  return values;
}

TEST(Interpolator, FindsSmoothFunctionsAndTheirDerivatives) {
  const MatrixXd points = randomMatrix(2, 120, 1), tests = 0.9 * randomMatrix(2, 50, 2);
  const Interpolator interpolator = fitInterpolator(points, calcFunctions(points));
  Interpolator::Workspace workspace;
  for (Eigen::Index i = 0; i < tests.cols(); ++i) {
    const VectorXd x = tests.col(i);
    interpolator.evaluate(x, workspace);
    EXPECT_LT((workspace.values - calcFunctions(x)).cwiseAbs().maxCoeff(), 0.05);
    EXPECT_NEAR(workspace.jacobian(0, 0), 2000.0 * std::cos(2.0 * x(0) + x(1)), 2.0);
    EXPECT_NEAR(workspace.jacobian(1, 1), x(0), 0.05);
    EXPECT_NEAR(workspace.jacobian(2, 1), std::exp(x(1)), 0.05);
  }
}

TEST(Interpolator, ThePointsLeftOutTellItsAccuracy) {
  const MatrixXd points = randomMatrix(2, 60, 1), tests = 0.9 * randomMatrix(2, 2000, 2);
  const Interpolator interpolator = fitInterpolator(points, calcFunctions(points));
  Interpolator::Workspace workspace;
  VectorXd squares = VectorXd::Zero(3);
  for (Eigen::Index i = 0; i < tests.cols(); ++i) {
    interpolator.evaluate(tests.col(i), workspace);
    squares += (workspace.values - calcFunctions(tests.col(i))).cwiseAbs2() / tests.cols();
  }
  constexpr double kUnimportant = 0.01;  // of the accuracy that is wanted, 1: below it, nothing is sought
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(squares(k), kUnimportant + 4.0 * interpolator.getParts().left_out_variance(k)) << k;
  }
}

TEST(Interpolator, TakesOneVariableAndPassesThroughItsPoints) {
  const MatrixXd points = Eigen::RowVectorXd::LinSpaced(12, -1.0, 1.0);
  const MatrixXd values = (3.0 * points.array()).sin();
  const Interpolator interpolator = fitInterpolator(points, values);
  Interpolator::Workspace workspace;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    interpolator.evaluate(points.col(i), workspace);
    EXPECT_NEAR(workspace.values(0), values(0, i), 1e-5);
  }
}

TEST(Interpolator, RefusesSizesThatDoNotFitAndWhatIsNotFinite) {
  const MatrixXd points = randomMatrix(2, 20, 1);
  EXPECT_THROW((void)fitInterpolator(points, MatrixXd::Zero(1, 19)), std::invalid_argument);
  EXPECT_THROW((void)fitInterpolator(points.leftCols(3), MatrixXd::Zero(1, 3)), std::invalid_argument);
  MatrixXd values = MatrixXd::Zero(1, 20);
  values(0, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)fitInterpolator(points, values), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap::gp
