#include "framework/simulation/excitation/cubic_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap {
namespace {

using Vector = std::vector<double>;

const Vector kTimes{0.5, 0.7, 1.0, 1.6, 1.65, 2.4, 3.0};
const Vector kValues{1.0, -2.0, 0.5, 3.0, 2.5, -1.0, 0.25};

/// The spline through the first `count` points, compared at some times.
void expectValues(std::size_t count, const Vector& at, const Vector& expected) {
  const CubicSpline spline(Vector(kTimes.begin(), kTimes.begin() + count),
                           Vector(kValues.begin(), kValues.begin() + count));
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(spline.calc(at[i] - kTimes[0]), expected[i], 1e-13) << count << " points, t = " << at[i];
  }
}

// Goldens: scipy 1.10, scipy.interpolate.CubicSpline(kTimes[:count], kValues[:count])(at)
TEST(CubicSpline, IsScipysNotAKnotSpline) {
  expectValues(7, {0.5, 0.61, 0.9, 1.3, 1.62, 1.65, 2.0, 2.75, 2.999},
               {1.0, -1.3646219981946055, -0.7432333629741404, 3.373815883430792, 2.8072857993586795, 2.5,
                -0.08209605417980788, -0.5373089627513822, 0.2463574735619723});
  expectValues(4, {0.5, 0.61, 0.9, 1.3}, {1.0, -1.29205, -0.8936026936026932, 4.6848484848484855});
  expectValues(3, {0.5, 0.61, 0.9}, {1.0, -1.112, -1.2666666666666664});
  expectValues(2, {0.5, 0.6, 0.7}, {1.0, -0.5, -2.0});
}

TEST(CubicSpline, IsExactForCubicsAndGoesOnBeyondTheEnds) {
  const auto cubic = [](double t) { return 2.0 - t + 0.5 * t * t - 0.3 * t * t * t; };
  Vector values;
  for (const double t : kTimes) {
    values.push_back(cubic(t));
  }
  const CubicSpline spline(kTimes, values);
  for (const double t : {0.45, 0.5, 0.51, 1.61, 2.9, 3.1}) {
    EXPECT_NEAR(spline.calc(t - kTimes[0]), cubic(t), 1e-12);
  }
}

// Eight samples a period: the error of the spline is (2 pi / 8)^4 / 384 of the amplitude inside, 1e-3.
TEST(CubicSpline, FollowsASineOfEightSamplesAPeriod) {
  Vector times, values;
  for (int i = 0; i <= 1024; ++i) {
    times.push_back(i / 610.35);
    values.push_back(std::sin(2.0 * M_PI * i / 8.0));
  }
  const CubicSpline spline(times, values);
  double largest = 0.0;
  for (double i = 8.0; i < 1016.0; i += 0.37) {
    largest = std::max(largest, std::abs(spline.calc(i / 610.35) - std::sin(2.0 * M_PI * i / 8.0)));
  }
  EXPECT_LT(largest, 1.1 * std::pow(2.0 * M_PI / 8.0, 4) / 384.0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(spline.calc(times[i]), values[i], 1e-12);  // the segment of every point is found
  }
}

}  // namespace
}  // namespace twinmap
