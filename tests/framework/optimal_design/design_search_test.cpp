#include "framework/optimal_design/design_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace twinmap::experiment_design {
namespace {

using Eigen::VectorXd;

/// Several local optima, and a limit that cuts off the best of them.
DesignScore judge(const VectorXd& point) {
  const double x = point[0], y = point[1];
  const double cost = std::sin(9.0 * x) * std::cos(7.0 * y) + (x - 0.6) * (x - 0.6) + (y - 0.5) * (y - 0.5);
  return {cost, VectorXd::Constant(1, x + y), ""};
}

double searchGrid(double most) {
  constexpr int kGrid = 1000;
  double best = 1e9;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      const DesignScore score = judge(Eigen::Vector2d(double(i) / kGrid, double(j) / kGrid));
      best = score.measures[0] <= most ? std::min(best, score.cost) : best;
    }
  }
  return best;
}

TEST(DesignSearch, FindsTheOptimumOfAnExhaustiveGridFromAnySeed) {
  constexpr double kMax = 0.9;
  const double best = searchGrid(kMax);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DesignSearch search(judge, VectorXd::Constant(1, kMax), {300, false, seed});
    search.run(Eigen::Vector2d(0.1, 0.1));
    ASSERT_NE(search.findBest(), nullptr);
    EXPECT_LE(search.findBest()->score.measures[0], kMax);
    found += search.findBest()->score.cost < best + 0.01 ? 1 : 0;
  }
  EXPECT_GE(found, 8);
}

TEST(DesignSearch, KeepsItsBudgetAndRepeatsItsPath) {
  DesignSearch a(judge, VectorXd::Constant(1, 0.9), {200, true, 3}), b = a;
  a.run(Eigen::Vector2d(0.1, 0.1));
  b.run(Eigen::Vector2d(0.1, 0.1));
  EXPECT_LE(a.getPath().size(), 203U);
  ASSERT_EQ(a.getPath().size(), b.getPath().size());
  for (std::size_t i = 0; i < a.getPath().size(); ++i) {
    EXPECT_EQ(a.getPath()[i].point, b.getPath()[i].point);
  }
}

TEST(DesignSearch, HasNoBestWhereNoDesignKeepsTheLimits) {
  const auto far = [](const VectorXd& point) {
    return DesignScore{0.0, VectorXd::Constant(1, 2.0 + point.squaredNorm()), ""};
  };
  DesignSearch search(far, VectorXd::Constant(1, 1.0), {100, false, 1});
  search.run(Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(search.findBest(), nullptr);
  EXPECT_NEAR(search.findLeastViolation().score.measures[0], 2.0, 1e-2);
}

TEST(DesignSearch, GoesOnBesideDesignsThatFail) {
  const auto half = [](const VectorXd& point) {
    return point[0] > 0.5 ? DesignScore{std::nan(""), {}, "pulse ends before it starts"}
                          : DesignScore{-point[0], VectorXd(), ""};
  };
  DesignSearch search(half, VectorXd(), {100, false, 1});
  search.run(VectorXd::Constant(1, 0.1));
  ASSERT_NE(search.findBest(), nullptr);
  EXPECT_NEAR(search.findBest()->point[0], 0.5, 0.02);
}

}  // namespace
}  // namespace twinmap::experiment_design
