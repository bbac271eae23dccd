#include "kernels/surrogate/box_moments.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUniformVariance = 1.0 / 3.0;

/// By the midpoint rule on a grid of the square.
Moments integrate(const MatrixXd& precision, const VectorXd& shift) {
  constexpr int kCells = 800;
  double sum = 0.0;
  VectorXd first = VectorXd::Zero(2);
  MatrixXd second = MatrixXd::Zero(2, 2);
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const Eigen::Vector2d x(-1.0 + (2.0 * i + 1.0) / kCells, -1.0 + (2.0 * j + 1.0) / kCells);
      const double density = std::exp(shift.dot(x) - 0.5 * x.dot(precision * x));
      sum += density;
      first += density * x;
      second += density * x * x.transpose();
    }
  }
  first /= sum;
  return {first, second / sum - first * first.transpose()};
}

TEST(BoxMoments, WithinTheBoxAreThoseOfTheLikelihood) {
  const MatrixXd precision = (MatrixXd(2, 2) << 4000.0, 1500.0, 1500.0, 2500.0).finished();
  const VectorXd mean = (VectorXd(2) << 0.3, -0.5).finished();
  const Moments found = calcBoxMoments(precision, precision * mean);
  EXPECT_LT((found.mean - mean).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((found.covariance * precision - MatrixXd::Identity(2, 2)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(BoxMoments, OfAnUninformativeLikelihoodAreTheBoxs) {
  const Moments found = calcBoxMoments(MatrixXd::Zero(3, 3), VectorXd::Zero(3));
  EXPECT_LT(found.mean.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((found.covariance.diagonal().array() - kUniformVariance).abs().maxCoeff(), 1e-5);
}

TEST(BoxMoments, OfOneVariableAreExact) {
  // exp(b x) on [-1, 1]: mean coth(b) - 1 / b, variance 1 / b^2 - 1 / sinh(b)^2.
  for (const double b : {0.5, 3.0, 40.0}) {
    const Moments found = calcBoxMoments(MatrixXd::Zero(1, 1), VectorXd::Constant(1, b));
    EXPECT_NEAR(found.mean(0), 1.0 / std::tanh(b) - 1.0 / b, 1e-4) << b;
    const double variance = 1.0 / (b * b) - 1.0 / std::pow(std::sinh(b), 2);
    EXPECT_NEAR(found.covariance(0, 0) / variance, 1.0, 1e-3) << b;
  }
}

TEST(BoxMoments, OfCorrelatedVariablesAtTheBoundsAreNearTheIntegrals) {
  const MatrixXd precision = (MatrixXd(2, 2) << 12.0, -8.0, -8.0, 9.0).finished();
  for (const double where : {0.2, 0.9, 1.6}) {
    const VectorXd shift = precision * VectorXd::Constant(2, where);
    const Moments found = calcBoxMoments(precision, shift), expected = integrate(precision, shift);
    // Expectation propagation is an approximation; a tenth of a standard deviation is its own accuracy.
    EXPECT_LT(((found.mean - expected.mean).array() / expected.covariance.diagonal().array().sqrt())
                  .abs()
                  .maxCoeff(),
              0.1);
    EXPECT_LT(
        (found.covariance.diagonal().array() / expected.covariance.diagonal().array() - 1.0).abs().maxCoeff(),
        0.15);
  }
}

}  // namespace
}  // namespace twinmap::gp
