#include "framework/data/measurement/recording/interpolation_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRegularCount = 400;
constexpr double kStep = 0.1;

VectorXd sample(double samples_per_period) {
  const double rate = 2.0 * std::acos(-1.0) / samples_per_period;
  return VectorXd::NullaryExpr(kRegularCount,
                               [&](Index i) { return std::sin(rate * static_cast<double>(i)); });
}

std::vector<double> listMiddles() {
  std::vector<double> middles;
  for (Index i = 3; i < kRegularCount - 3; ++i) {
    middles.push_back(kStep * (static_cast<double>(i) + 0.5));
  }
  return middles;
}

const VectorXd kRegular = VectorXd::LinSpaced(kRegularCount, 0.0, kStep*(kRegularCount - 1));

// In the middle of four samples the cubic takes (9 (a + b) - (c + d)) / 16, so that of a sine it leaves
// 1 - (9 cos(w / 2) - cos(3 w / 2)) / 8.
TEST(InterpolationError, IsNearlyThatOfACubicThroughASine) {
  for (const double per_period : {6.0, 10.0, 20.0}) {
    const double w = 2.0 * std::acos(-1.0) / per_period;
    const double left = 1.0 - (9.0 * std::cos(0.5 * w) - std::cos(1.5 * w)) / 8.0;
    const double found = calcInterpolationError(kRegular, sample(per_period), listMiddles(), 0.0);
    EXPECT_NEAR(found / (left / std::sqrt(2.0)), 1.0, 0.25) << per_period;
  }
}

TEST(InterpolationError, IsNotThatOfNoise) {
  VectorXd noise(kRegularCount);
  RandomStream(1, RandomPurpose::kSingleNoise).drawNormals(0, 0, noise.data(), kRegularCount);
  EXPECT_LT(calcInterpolationError(kRegular, noise, listMiddles(), 1.0), 0.1);
}

TEST(InterpolationError, IsNotThatOfLostSamples) {
  const VectorXd values = sample(60.0);
  std::vector<Index> kept;
  for (Index i = 0; i < kRegularCount; ++i) {
    if (i < 100 || i > 130) {
      kept.push_back(i);
    }
  }
  const double whole = calcInterpolationError(kRegular, values, listMiddles(), 0.0);
  const double found = calcInterpolationError(kRegular(kept), values(kept), listMiddles(), 0.0);
  EXPECT_NEAR(found / whole, 1.0, 0.1);
}

TEST(InterpolationError, IsNoneAtSamples) {
  EXPECT_EQ(calcInterpolationError(kRegular, sample(5.0), {1.0, 2.0, 3.0}, 0.0), 0.0);
}

}  // namespace
}  // namespace twinmap
