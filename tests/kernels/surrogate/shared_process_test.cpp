#include "kernels/surrogate/shared_process.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/surrogate/fit_shared_process.hpp"
#include "tests/kernels/golden/surrogate_golden.hpp"
#include "tests/kernels/support/random_data.hpp"

namespace twinmap::gp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::randomMatrix;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Inverses of matrices of condition 1e4 in Python against triangular factors here.
constexpr double kTolerance = 1e-9;

MatrixXd toMatrix(const std::vector<double>& values, Index rows) {
  return Eigen::Map<const Rows>(values.data(), rows, static_cast<Index>(values.size()) / rows);
}

const MatrixXd kPoints = toMatrix(golden::kPoints, 2);
const MatrixXd kValues = toMatrix(golden::kValues, kPoints.cols());
const SharedHyperparameters kHyperparameters{toMatrix(golden::kLengthScales, 2), golden::kNugget};

TEST(SharedProcess, LeavesPointsOutAsIfTheOthersWereFittedAnew) {
  for (const golden::SharedCase& expected : golden::kCases) {
    LeftOutDensity density(kPoints, kValues, expected.structure);
    double found = 0.0;
    ASSERT_TRUE(density.evaluate(kHyperparameters, found));
    EXPECT_NEAR(found, expected.density, kTolerance * std::abs(expected.density) + kTolerance);
    const LeftOut& left_out = density.getLeftOut();
    EXPECT_LT((left_out.residual - toMatrix(expected.residual, kPoints.cols())).cwiseAbs().maxCoeff(),
              kTolerance);
    EXPECT_LT((left_out.variance - toMatrix(expected.variance, kPoints.cols())).cwiseAbs().maxCoeff(),
              kTolerance);
  }
}

TEST(SharedProcess, PredictsWithATrendAndALocalFactor) {
  for (const golden::SharedCase& expected : golden::kCases) {
    const SharedProcess process(kPoints, kValues, expected.structure, kHyperparameters);
    SharedProcess::Workspace workspace;
    VectorXd mean(3), stddev(3);
    process.evaluate(toMatrix(golden::kAt, 2), mean, workspace);
    process.calcStddev(stddev, workspace);
    EXPECT_LT((mean - toMatrix(expected.mean, 3)).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_LT((stddev - toMatrix(expected.stddev, 3)).cwiseAbs().maxCoeff(), kTolerance);
  }
}

TEST(SharedProcess, DerivativesAreThoseOfItsValues) {
  constexpr double kStep = 1e-5;
  for (const golden::SharedCase& of : golden::kCases) {
    const SharedProcess process(kPoints, kValues, of.structure, kHyperparameters);
    SharedProcess::Workspace workspace;
    const VectorXd at = toMatrix(golden::kAt, 2);
    VectorXd above(3), below(3);
    MatrixXd jacobian(3, 2);
    process.linearize(at, above, jacobian, workspace);
    for (Index v = 0; v < 2; ++v) {
      process.evaluate(at + kStep * VectorXd::Unit(2, v), above, workspace);
      process.evaluate(at - kStep * VectorXd::Unit(2, v), below, workspace);
      EXPECT_LT((jacobian.col(v) - (above - below) / (2.0 * kStep)).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST(LeftOutDensity, GradientIsThatOfItsValue) {
  constexpr double kStep = 1e-5;
  for (const golden::SharedCase& of : golden::kCases) {
    LeftOutDensity density(kPoints, kValues, of.structure);
    double found = 0.0, above = 0.0, below = 0.0;
    VectorXd gradient;
    ASSERT_TRUE(density.evaluate(kHyperparameters, found, gradient));
    for (Index k = 0; k < 3; ++k) {
      const auto evaluateAt = [&](double factor, double& value) {
        SharedHyperparameters moved = kHyperparameters;
        (k < 2 ? moved.length_scales(k) : moved.nugget) *= factor;
        return density.evaluate(moved, value);
      };
      ASSERT_TRUE(evaluateAt(std::exp(kStep), above));
      ASSERT_TRUE(evaluateAt(std::exp(-kStep), below));
      EXPECT_NEAR(gradient(k), (above - below) / (2.0 * kStep), 1e-5 * (1.0 + std::abs(gradient(k)))) << k;
    }
  }
}

/// Functions in units of their measurement's noise, the first large.
MatrixXd calcFunctions(const MatrixXd& points) {
  MatrixXd values(points.cols(), 2);
  values.col(0) = 300.0 * (2.0 * points.row(0) + points.row(1)).array().sin().transpose();
  values.col(1) = 5.0 * (points.row(0).array() * points.row(2).array()).exp().transpose();
  return values;
}

TEST(ChooseSharedProcess, LearnsSmoothFunctionsFarBelowTheNoiseAndKnowsItsError) {
  const MatrixXd points = randomMatrix(3, 150, 1), tests = randomMatrix(3, 400, 2);
  const MatrixXd values = calcFunctions(points), truth = calcFunctions(tests);
  const SharedChoice choice = chooseSharedProcess(points, values);
  const SharedProcess process(points, values, choice.structure, choice.hyperparameters);
  SharedProcess::Workspace workspace;
  VectorXd mean(2), stddev(2);
  double squares = 0.0, worst = 0.0;
  for (Index i = 0; i < tests.cols(); ++i) {
    process.evaluate(tests.col(i), mean, workspace);
    process.calcStddev(stddev, workspace);
    const VectorXd error = mean - truth.row(i).transpose();
    squares += error.cwiseQuotient(stddev).squaredNorm() / (2.0 * static_cast<double>(tests.cols()));
    worst = std::max(worst, error.cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 1.0);  // the noise
  EXPECT_GT(squares, 0.3);
  EXPECT_LT(squares, 3.0);
}

TEST(ChooseSharedProcess, RefusesTooFewPoints) {
  const MatrixXd points = randomMatrix(3, 5, 1);
  EXPECT_THROW((void)chooseSharedProcess(points, calcFunctions(points)), std::invalid_argument);
}

}  // namespace
}  // namespace twinmap::gp
