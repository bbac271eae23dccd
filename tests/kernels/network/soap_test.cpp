#include "kernels/network/soap.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/golden/network_golden.hpp"
#include "tests/kernels/network/waves.hpp"

namespace twinmap::network {
namespace {

/// Ten steps after the first gradient of the script's problem.
MatrixXd takeTenSteps(Index rows, Index cols, Index largest_side) {
  SoapOptions options;
  options.largest_side = largest_side;
  options.basis_interval = 3;
  SoapMatrix soap(rows, cols, options);
  MatrixXd weights = makeWave(rows, cols, 1);
  const MatrixXd left = makeWave(rows, rows, 2), right = makeWave(cols, cols, 3);
  for (int step = 0; step < 11; ++step) {
    soap.step(left * weights * right + makeWave(rows, cols, 4 + step), 0.1, weights);
  }
  return weights;
}

void expectEqual(const MatrixXd& found, const std::vector<double>& by_rows) {
  for (Index row = 0; row < found.rows(); ++row) {
    for (Index col = 0; col < found.cols(); ++col) {
      EXPECT_NEAR(found(row, col), by_rows[static_cast<std::size_t>(row * found.cols() + col)], 1e-10);
    }
  }
}

TEST(Soap, TakesTheStepsOfNumpy) {
  expectEqual(takeTenSteps(6, 6, 100), golden::kSoapSquare);
}

TEST(Soap, LeavesALongSideAsItIs) {
  expectEqual(takeTenSteps(4, 7, 5), golden::kSoapOneSide);
}

TEST(Soap, MinimisesAQuadraticWhoseDirectionsAreTurned) {
  // f = |A (W - T)|^2 / 2 with the condition 10^4
  const Index n = 8;
  MatrixXd a = makeWave(n, n, 7);
  a.col(0) *= 1e-2;
  const MatrixXd target = makeWave(n, n, 8);
  SoapMatrix soap(n, n, {});
  MatrixXd weights = MatrixXd::Zero(n, n);
  const double before = (a * (weights - target)).norm();
  for (int step = 0; step < 2000; ++step) {
    soap.step(a.transpose() * (a * (weights - target)), 0.02 * (1.0 - step / 2000.0), weights);
  }
  EXPECT_LT((a * (weights - target)).norm(), 1e-2 * before);
}

TEST(AdamVector, FirstStepIsTheLearningRate) {
  AdamVector adam(2, {});
  VectorXd values = VectorXd::Zero(2);
  const VectorXd gradient = Eigen::Vector2d(3.0, -0.2);
  adam.step(gradient, 0.1, values);
  EXPECT_TRUE(values.isZero(0.0));  // the first gradient is skipped
  adam.step(gradient, 0.1, values);
  EXPECT_NEAR(values[0], -0.1, 1e-8);
  EXPECT_NEAR(values[1], 0.1, 1e-7);
}

}  // namespace
}  // namespace twinmap::network
