#include "kernels/tracking/box_site.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinmap::tracking {
namespace {

struct CutMoments {
  double mean, variance;
};

/// Of a normal distribution within [-1, 1], by a fine grid.
CutMoments cut(double mean, double stddev) {
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int i = 0; i <= 20000; ++i) {
    const double x = -1.0 + 1e-4 * i, z = (x - mean) / stddev;
    const double density = std::exp(-0.5 * z * z) * (i == 0 || i == 20000 ? 0.5 : 1.0);
    sum += density;
    first += density * x;
    second += density * x * x;
  }
  first /= sum;
  return {first, second / sum - first * first};
}

TEST(BoxSite, LeavesTheLikelihoodThatBoundsCutOff) {
  for (const double stddev : {0.05, 0.2, 0.5, 1.0}) {
    for (const double mean : {-0.9, 0.0, 0.4, 1.05}) {
      const CutMoments moments = cut(mean, stddev);
      const BoxSite site = calcBoxSite(0, moments.mean, moments.variance);
      const double precision = 1.0 / moments.variance - site.precision;
      EXPECT_NEAR(precision * stddev * stddev, 1.0, 2e-3) << mean << " " << stddev;
      EXPECT_NEAR((moments.mean / moments.variance - site.shift) / precision, mean, 2e-3 * stddev)
          << mean << " " << stddev;
    }
  }
}

TEST(BoxSite, IsNothingAmidTheBoundsAndAllWhereNothingIsKnown) {
  const BoxSite narrow = calcBoxSite(0, 0.5, 1e-4);
  EXPECT_EQ(narrow.precision, 0.0);
  EXPECT_EQ(narrow.shift, 0.0);
  EXPECT_NEAR(calcBoxSite(0, 0.0, 1.0 / 3.0).precision, 3.0, 1e-3);
  EXPECT_NEAR(calcBoxSite(0, 0.1, 0.5).precision, 2.0, 1e-6);
}

/// What the mean of many likelihoods says, each seen through a posterior within the bounds.
TEST(BoxSite, LetsManyMeasurementsAddUpToTheTruth) {
  constexpr double kTruth = 0.5, kStddev = 0.3;
  constexpr int kCount = 400;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(kTruth, kStddev);
  double precision = 0.0, shift = 0.0, normal_precision = 0.0, normal_shift = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const CutMoments moments = cut(normal(random), kStddev);
    const BoxSite site = calcBoxSite(0, moments.mean, moments.variance);
    precision += 1.0 / moments.variance - site.precision;
    shift += moments.mean / moments.variance - site.shift;
    normal_precision += 1.0 / moments.variance - 3.0;
    normal_shift += moments.mean / moments.variance;
  }
  EXPECT_LT(std::abs(shift / precision - kTruth) * std::sqrt(precision), 3.0);
  EXPECT_GT(std::abs(normal_shift / normal_precision - kTruth) * std::sqrt(normal_precision), 3.0);
}

}  // namespace
}  // namespace twinmap::tracking
