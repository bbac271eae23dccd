#include "framework/estimation/posterior/bound_test.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

using Found = std::vector<Eigen::Index>;

/// A minimum with the first coordinate at its upper bound, the second inside. A linear response of n samples
/// of noise 1 that changes by `slope` a half-width, and still misses by `miss` noise sd at the bound.
LocalSurface makeHeld(double samples, double slope, double miss) {
  LocalSurface minimum;
  minimum.at = Eigen::Vector2d(1.0, 0.2);
  minimum.information = Eigen::Vector2d(samples * slope * slope, samples).asDiagonal();
  minimum.descent = Eigen::Vector2d(samples * slope * miss, 0.0);
  return minimum;
}

TEST(FindBeyondBounds, NamesWhatWouldLeaveThemIfItCould) {
  EXPECT_EQ(findBeyondBounds(makeHeld(400.0, 1.0, 0.5)), Found{0});
  EXPECT_EQ(findBeyondBounds(makeHeld(400.0, 1.0, 0.05)), Found{});  // gain 1: noise
  EXPECT_EQ(findBeyondBounds(makeHeld(400.0, 1.0, -0.5)), Found{});  // it leads back
}

TEST(FindBeyondBounds, NamesAStartFarOutsideBoundsThatAreNarrowBesideTheNoise) {
  // a counter that starts 9000 rad off, within +-10 rad, taken for noise of 1.93e4 rad
  EXPECT_EQ(findBeyondBounds(makeHeld(1000.0, 10.0 / 1.93e4, 9000.0 / 1.93e4)), Found{0});
  EXPECT_EQ(findBeyondBounds(makeHeld(1000.0, 10.0 / 1.93e4, 0.05)), Found{});
}

TEST(FindBeyondBounds, NamesNothingThatIsNotSeen) {
  EXPECT_EQ(findBeyondBounds(makeHeld(1000.0, 0.0, 1.0)), Found{});
}

}  // namespace
}  // namespace twinmap
