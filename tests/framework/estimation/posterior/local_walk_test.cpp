#include "framework/estimation/posterior/draws/local_walk.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeMatrix;
using testing::makeVector;
using testing::Problem;
using testing::Surface;

TEST(LocalWalk, IsTheExactPosteriorOfALinearResponseAndANormalPrior) {
  const MatrixXd matrix = makeMatrix(10, 2);
  Surface linear(
      10, [=](const VectorXd& x) -> VectorXd { return matrix * x; }, testing::makeParameters(2, -1.0, 1.0),
      0.5, makeVector({0.2, -0.1}));
  const VectorXd at = makeVector({-0.3, 0.4});
  const double stddev = 0.7;
  const auto parts = linearizeAt(linear.surface, at, stddev * MatrixXd::Identity(2, 2));
  ASSERT_EQ(parts.size(), 1u);
  const MatrixXd precision =
      matrix.transpose() * matrix / 0.25 + MatrixXd::Identity(2, 2) / (stddev * stddev);
  const MatrixXd covariance = precision.inverse();
  const VectorXd measured = matrix * makeVector({0.2, -0.1});
  const VectorXd mean = covariance * (matrix.transpose() * measured / 0.25 + at / (stddev * stddev));
  EXPECT_TRUE(parts[0].mean.isApprox(mean, 1e-6));
  EXPECT_TRUE((parts[0].lower * parts[0].lower.transpose()).isApprox(covariance, 1e-6));
}

TEST(LocalWalk, GoesFromOnePlaceThroughAllOfABentValley) {
  // x0 is uniform but for a weak measurement, x1 = x0^2 to .05
  Surface banana(
      2,
      [](const VectorXd& x) {
        return makeVector({0.05 * x[0], 2.0 * (x[1] - x[0] * x[0])});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.1, makeVector({0.1, 0.01}));
  const MatrixXd starts = makeVector({0.9, 0.81}).replicate(1, 48);
  const MatrixXd places = walkPosterior(banana.surface, starts, 2000, 1);
  ASSERT_EQ(places.cols(), 48 * 1000);
  const Eigen::ArrayXd first = places.row(0).array();
  EXPECT_NEAR(first.mean(), 0.0, 0.1);
  EXPECT_NEAR(std::sqrt((first - first.mean()).square().mean()), 1.0 / std::sqrt(3.0), 0.06);
  const Eigen::ArrayXd apart = places.row(1).array() - first.square().transpose();
  EXPECT_NEAR(std::sqrt(apart.square().mean()), 0.05, 0.005);
}

/// Mean and standard deviation of each of x, where x0 + x1 x2 is known, by the midpoint rule: the oracle.
MatrixXd integrateSum(double measured, double noise_stddev, double lower, double upper) {
  constexpr int kCells = 150;
  VectorXd sum = VectorXd::Zero(3), squares = VectorXd::Zero(3);
  double mass = 0.0;
  const auto at = [&](int i) { return lower + (upper - lower) * (i + 0.5) / kCells; };
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const VectorXd x = makeVector({at(i % kCells), at(i / kCells % kCells), at(i / kCells / kCells)});
    const double z = (x[0] + x[1] * x[2] - measured) / noise_stddev;
    const double weight = std::exp(-0.5 * z * z);
    mass += weight;
    sum += weight * x;
    squares += weight * x.cwiseProduct(x);
  }
  MatrixXd moments(3, 2);
  moments.col(0) = sum / mass;
  moments.col(1) = (squares / mass - moments.col(0).cwiseProduct(moments.col(0))).cwiseSqrt();
  return moments;
}

TEST(LocalWalk, ServesWherePartsOfBasinsDoNot) {
  // three times a sum of a parameter and a product, which neither logarithms nor the parameters straighten
  constexpr double kStddev = 0.1, kLower = 0.2, kUpper = 3.0;
  const auto response = [](const VectorXd& x) -> VectorXd {
    return makeVector({x[0] + x[1] * x[2], x[3] + x[4] * x[5], x[6] + x[7] * x[8]});
  };
  Problem problem(3, response, testing::makeParameters(9, kLower, kUpper), kStddev);
  const VectorXd features = makeVector({2.5, 4.0, 6.0});
  const SimulatorPosterior posterior =
      samplePosterior(problem.simulator, problem.model, {}, features, VectorXd::Zero(9), MatrixXd(9, 0), {});
  ASSERT_TRUE(posterior.isReliable()) << posterior.message;
  for (Index k = 0; k < 3; ++k) {
    const MatrixXd expected = integrateSum(features[k], kStddev, kLower, kUpper);
    for (Index j = 0; j < 3; ++j) {
      EXPECT_NEAR(posterior.mean[3 * k + j], expected(j, 0), 0.3 * expected(j, 1));
      EXPECT_NEAR(posterior.stddev[3 * k + j] / expected(j, 1), 1.0, 0.25);
    }
  }
  EXPECT_GT(posterior.simulations, 48 * 48);  // of the chains
}

}  // namespace
}  // namespace twinmap
