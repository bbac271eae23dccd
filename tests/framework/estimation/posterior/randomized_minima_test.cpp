#include "framework/estimation/posterior/draws/randomized_minima.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/linalg/decompositions.hpp"
#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Surface;

constexpr double kBentNoise = 0.1, kAlong = 0.2;

/// A parabola's floor along the first parameter, narrow across it and bent by many standard deviations.
VectorXd respondBent(const VectorXd& x) {
  return makeVector({kAlong * x[0], 5.0 * (x[1] - x[0] * x[0])});
}

TEST(RandomizedMinima, HaveTheDensityOfTheirMap) {
  Surface surface(2, respondBent, testing::makeParameters(2, -1.0, 1.0), kBentNoise, makeVector({0.1, 0.2}));
  const auto minima =
      RandomizedMinima::measure(surface.surface, surface.makeBasins(makeVector({0.1, 0.2})).front());
  ASSERT_TRUE(minima);
  const auto calcLogDensity = [&](const VectorXd& normals) {
    constexpr double kStep = 1e-5;
    MatrixXd slopes(2, 2);
    for (Index j = 0; j < 2; ++j) {
      const VectorXd step = kStep * VectorXd::Unit(2, j);
      slopes.col(j) =
          (minima->draw(normals + step)->point - minima->draw(normals - step)->point) / (2 * kStep);
    }
    return -0.5 * normals.squaredNorm() - linalg::calcLogDeterminant(slopes).log_size;
  };
  const VectorXd first = makeVector({0.0, 0.0});
  for (const VectorXd& normals : {makeVector({1.0, -0.5}), makeVector({-1.5, 0.7}), makeVector({0.2, 2.0})}) {
    EXPECT_NEAR(minima->draw(normals)->log_density - minima->draw(first)->log_density,
                calcLogDensity(normals) - calcLogDensity(first), 1e-6);
  }
}

/// Moments of a posterior that is bent by many of its standard deviations: those of a fine grid.
TEST(RandomizedMinima, FollowABentValley) {
  Surface surface(2, respondBent, testing::makeParameters(2, -1.0, 1.0), kBentNoise, makeVector({0.1, 0.2}));
  const auto minima =
      RandomizedMinima::measure(surface.surface, surface.makeBasins(makeVector({0.1, 0.2})).front());
  const importance::AdaptiveDraws drawn = sampleRandomizedMinima(surface.surface, *minima, 2000, 1, 1);
  EXPECT_TRUE(drawn.isReliable());
  EXPECT_GT(drawn.effective_sample_size, 1000.0);
  double sum = 0.0;
  VectorXd mean = VectorXd::Zero(2), squares = VectorXd::Zero(2);
  for (double a = -0.995; a < 1.0; a += 0.01) {
    for (double b = -0.999; b < 1.0; b += 0.002) {
      const VectorXd x = makeVector({a, b});
      const double density =
          std::exp(-0.5 * (surface.features - respondBent(x)).squaredNorm() / (kBentNoise * kBentNoise));
      sum += density;
      mean += density * x;
      squares += density * x.cwiseAbs2();
    }
  }
  mean /= sum;
  const VectorXd stddev = (squares / sum - mean.cwiseAbs2()).cwiseSqrt();
  const VectorXd drawn_mean = importance::calcMean(drawn.draws);
  const MatrixXd covariance = importance::calcCovariance(drawn.draws);
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(drawn_mean[j], mean[j], 0.05 * stddev[j]) << j;
    EXPECT_NEAR(std::sqrt(covariance(j, j)), stddev[j], 0.05 * stddev[j]) << j;
  }
}

/// Where the map folds back no draw is made.
TEST(RandomizedMinima, AreNoneBeyondAFold) {
  Surface surface(
      1, [](const VectorXd& x) { return makeVector({x[0] + 0.5 * x[0] * x[0]}); },
      testing::makeParameters(1, -5.0, 5.0), kBentNoise, makeVector({0.0}));
  const auto minima =
      RandomizedMinima::measure(surface.surface, surface.makeBasins(makeVector({0.0})).front());
  ASSERT_TRUE(minima);
  EXPECT_TRUE(minima->draw(makeVector({-4.0})));  // x + x^2 / 2 >= -.5, five of the noise
  EXPECT_FALSE(minima->draw(makeVector({-6.0})));
}

}  // namespace
}  // namespace twinmap
