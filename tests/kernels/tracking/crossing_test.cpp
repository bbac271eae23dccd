#include "kernels/tracking/crossing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinmap::tracking {
namespace {

TEST(Crossing, OfALineIsWhereItMeetsTheLimit) {
  const Crossing crossing = findCrossing({10.0, 0.0, -0.5, 0.0, 0.0, 0.0}, 8.0, true, 1000.0);
  EXPECT_NEAR(crossing.median, 4.0, 1e-6);
  EXPECT_NEAR(crossing.lower, 4.0, 1e-6);
}

TEST(Crossing, OfAWalkIsReflected) {
  // P(max of Brownian motion until t > b) = 2 (1 - Phi(b / sqrt(t)))
  const double expected = std::erfc(1.5 / std::sqrt(2.0 * 4.0));
  EXPECT_NEAR(calcPassed({0.0, 0.0, 0.0, 0.0, 1.0, 0.0}, 1.5, false, 4.0), expected, 1e-9);
}

TEST(Crossing, NeverIsInfinite) {
  const Crossing crossing = findCrossing({10.0, 0.1, 0.5, 0.01, 0.0, 0.0}, 8.0, true, 1000.0);
  EXPECT_EQ(crossing.median, Crossing::kNever);
}

TEST(Crossing, IsThatOfSimulatedWalks) {
  const Outlook outlook{10.0, 0.3, -0.05, 0.01, 0.02, 0.0};
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kWalks = 4000, kSteps = 400;
  constexpr double kStep = 0.05;
  int passed = 0;
  for (int w = 0; w < kWalks; ++w) {
    double level = 10.0 + 0.3 * normal(random);
    const double slope = -0.05 + 0.01 * normal(random);
    bool has_passed = level <= 8.5;
    for (int i = 0; i < kSteps && !has_passed; ++i) {
      level += slope * kStep + std::sqrt(0.02 * kStep) * normal(random);
      has_passed = level <= 8.5;
    }
    passed += has_passed ? 1 : 0;
  }
  // a walk that is looked at every kStep passes .58 sqrt(q kStep) later; 3 standard errors are .024
  const double later = 0.58 * std::sqrt(0.02 * kStep);
  EXPECT_NEAR(calcPassed(outlook, 8.5 - later, true, kStep * kSteps), static_cast<double>(passed) / kWalks,
              0.024);
}

}  // namespace
}  // namespace twinmap::tracking
