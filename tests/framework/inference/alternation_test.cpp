// A wheel that coasts down, one stamp a mark: every other mark is off.
#include "framework/inference/measurement/alternation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Unevenly spaced times at which a wheel or another thing has turned by `calc`.
ResponseLayout makeMarks(Index count) {
  return {{"q"}, {"rad"}, VectorXd::NullaryExpr(count, [](Index i) {
            const auto k = static_cast<double>(i);
            return 0.1 + 0.2 * k + 5e-4 * k * k;
          })};
}

VectorXd turn(const ResponseLayout& layout, double off) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 5e-3);
  return VectorXd::NullaryExpr(layout.times.size(), [&](Index i) {
    const double t = layout.times[i];
    return 30.0 * t - 0.1 * t * t + (i % 2 == 1 ? off : 0.0) + noise(generator);
  });
}

TEST(Alternation, IsFoundAndTakenOff) {
  const ResponseLayout layout = makeMarks(120);
  for (const double off : {0.9, -0.05}) {
    const VectorXd measured = turn(layout, off);
    const Alternation found = findAlternation(measured, layout);
    ASSERT_EQ(found.said.size(), 1U) << off;
    const VectorXd left = measured + found.shift - turn(layout, 0.0);
    EXPECT_LT((left.array() - 0.5 * off).abs().maxCoeff(), 2e-3) << off;
  }
}

TEST(Alternation, IsNeitherNoiseNorAnOscillation) {
  const ResponseLayout layout = makeMarks(120);
  EXPECT_TRUE(findAlternation(turn(layout, 0.0), layout).said.empty());
  const VectorXd fast = (layout.times.array() * 9.0).sin().matrix();
  EXPECT_TRUE(findAlternation(fast, layout).said.empty());
  EXPECT_TRUE(findAlternation(turn(makeMarks(12), 0.9), makeMarks(12)).said.empty());
}

}  // namespace
}  // namespace twinmap
