#include "kernels/sampling/elliptical_slice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace twinmap::importance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SliceNumbers makeNumbers() {
  auto engine = std::make_shared<std::mt19937_64>(5);
  return {[engine] { return std::uniform_real_distribution<double>(1e-12, 1.0)(*engine); },
          [engine](int count) -> VectorXd {
            std::normal_distribution<double> normal;
            return VectorXd::NullaryExpr(count, [&] { return normal(*engine); });
          }};
}

struct Moments {
  VectorXd mean, stddev;
};

Moments calcMoments(const MatrixXd& draws) {
  const VectorXd mean = draws.rowwise().mean();
  return {mean, (draws.colwise() - mean).array().square().rowwise().mean().sqrt()};
}

TEST(EllipticalSlice, DrawsTheNormalDistributionWhereTheFactorIsConstant) {
  const MatrixXd lower = (MatrixXd(2, 2) << 2.0, 0.0, 1.2, 0.5).finished();
  const VectorXd mean = (VectorXd(2) << 3.0, -1.0).finished();
  const MatrixXd draws = sampleEllipticalSlices({mean, lower, [](const VectorXd&) { return 0.0; }}, mean,
                                                20000, 1, makeNumbers());
  const Moments moments = calcMoments(draws);
  EXPECT_NEAR(moments.mean[0], 3.0, 0.06);  // three standard errors
  EXPECT_NEAR(moments.mean[1], -1.0, 0.04);
  EXPECT_NEAR(moments.stddev[0], 2.0, 0.04);
  EXPECT_NEAR(moments.stddev[1], 1.3, 0.03);
}

TEST(EllipticalSlice, ANormalFactorIsAMeasurementMore) {
  // N(0, 1) times exp(-(x - 2)^2 / (2 .25)): mean 1.6, variance .2
  const MatrixXd draws =
      sampleEllipticalSlices({VectorXd::Zero(1), MatrixXd::Identity(1, 1),
                              [](const VectorXd& x) { return -2.0 * (x[0] - 2.0) * (x[0] - 2.0); }},
                             VectorXd::Zero(1), 20000, 5, makeNumbers());
  const Moments moments = calcMoments(draws);
  EXPECT_NEAR(moments.mean[0], 1.6, 0.02);
  EXPECT_NEAR(moments.stddev[0], std::sqrt(0.2), 0.015);
}

/// Twenty uniform distributions on [-1, 1], written as what they are of normal ones.
TEST(EllipticalSlice, FillsABoxOfManyDimensions) {
  constexpr int kDimensions = 20;
  const double stddev = 1.0 / std::sqrt(3.0);
  const auto factor = [&](const VectorXd& x) {
    return x.cwiseAbs().maxCoeff() <= 1.0 ? 1.5 * x.squaredNorm() : -std::numeric_limits<double>::infinity();
  };
  const MatrixXd draws = sampleEllipticalSlices(
      {VectorXd::Zero(kDimensions), stddev * MatrixXd::Identity(kDimensions, kDimensions), factor},
      VectorXd::Constant(kDimensions, 0.99), 2000, 50, makeNumbers());
  const Moments moments = calcMoments(draws);
  for (Index j = 0; j < kDimensions; ++j) {
    EXPECT_NEAR(moments.mean[j], 0.0, 0.06);
    EXPECT_NEAR(moments.stddev[j] / stddev, 1.0, 0.05);
  }
}

}  // namespace
}  // namespace twinmap::importance
