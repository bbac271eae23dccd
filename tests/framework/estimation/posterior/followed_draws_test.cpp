#include "framework/estimation/posterior/draws/followed_draws.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Surface;

constexpr double kSmallNoise = 0.01;

/// A product that is determined, of factors that are not.
VectorXd multiply(const VectorXd& x) {
  return makeVector({x[0] * x[1] * x[1], 0.0});
}

/// Weights of draws of the linear response are of no use here: it is off by a hundred standard deviations of
/// the noise. The product has the noise's, its factors all that the bounds allow.
TEST(FollowedDraws, LieOnAValleyThatBendsByFarMoreThanItIsWide) {
  Surface surface(2, multiply, testing::makeParameters(2, 1.0, 3.0), kSmallNoise, makeVector({2.0, 2.0}));
  const Basin basin = surface.makeBasins(makeVector({0.0, 0.0})).front();
  const importance::AdaptiveDraws drawn = drawFollowed(surface.surface, basin, 400, 1);
  EXPECT_TRUE(drawn.isReliable()) << drawn.findObstacle();
  double sum = 0.0, squares = 0.0, least = 3.0, most = 1.0;
  for (Index i = 0; i < drawn.draws.points.cols(); ++i) {
    const VectorXd point = surface.coordinates.toParameters(drawn.draws.points.col(i));
    const double product = drawn.draws.weights[i] * multiply(point)[0];
    sum += product;
    squares += product * multiply(point)[0];
    least = drawn.draws.weights[i] > 0.0 ? std::min(least, point[1]) : least;
    most = drawn.draws.weights[i] > 0.0 ? std::max(most, point[1]) : most;
  }
  EXPECT_NEAR(sum, 8.0, 0.2 * kSmallNoise);
  EXPECT_NEAR(std::sqrt(squares - sum * sum), kSmallNoise, 0.15 * kSmallNoise);
  EXPECT_LT(least, 1.75);  // 1.63 is where the other factor is at its bound
  EXPECT_GT(most, 2.5);    // of 2.83
}

}  // namespace
}  // namespace twinmap
