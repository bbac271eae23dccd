#include "framework/estimation/posterior/basins/search_team.hpp"

#include <gtest/gtest.h>

#include "framework/estimation/posterior/basins/valley.hpp"
#include "framework/estimation/posterior/bound_test.hpp"
#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Surface;

Surface makeBanana(double noise_stddev = 0.1) {
  return Surface(
      2,
      [](const VectorXd& x) {
        return makeVector({0.05 * x[0], 8.0 * (x[1] - x[0] * x[0])});
      },
      testing::makeParameters(2, -1.0, 1.0), noise_stddev, makeVector({0.1, 0.01}));
}

TEST(Connections, JoinTheEndsOfABentRidge) {
  Surface banana = makeBanana();
  MatrixXd ends(2, 2);
  ends << -0.9, 0.8,  //
      0.81, 0.64;
  const auto connected = findConnections(banana.surface, banana.makeBasins(ends));
  ASSERT_EQ(connected.size(), 1u);
  EXPECT_EQ(connected.front(), std::make_pair(std::size_t{0}, std::size_t{1}));
}

TEST(Connections, LeaveModesApartThatABarrierSeparates) {
  Surface mirror(
      2,
      [](const VectorXd& x) {
        return makeVector({x[0] * x[0], x[1]});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.02, makeVector({0.6, 0.2}));
  MatrixXd modes(2, 2);
  modes << 0.6, -0.6,  //
      0.2, 0.2;
  EXPECT_TRUE(findConnections(mirror.surface, mirror.makeBasins(modes)).empty());
}

TEST(SearchTeam, StaysWhereItIsHeld) {
  Surface banana = makeBanana();
  const MatrixXd start = makeVector({-0.5, 0.9}), held = makeVector({1.0, 0.0});
  SearchTeam team(banana.surface, start, held);
  team.run(10);
  EXPECT_NEAR(team.getLocal(0).at[0], -0.5, 1e-12);
  EXPECT_NEAR(team.getLocal(0).at[1], 0.25, 0.01);
}

TEST(SearchTeam, StopsAtABoundWhereDescentLeadsOut) {
  Surface outside(
      2, [](const VectorXd& x) { return VectorXd(x); }, testing::makeParameters(2, -1.0, 1.0), 0.05,
      makeVector({1.4, 0.3}));
  SearchTeam team(outside.surface, makeVector({0.0, 0.0}));
  team.run(20);
  EXPECT_EQ(team.getLocal(0).at[0], 1.0);
  EXPECT_NEAR(team.getLocal(0).at[1], 0.3, 1e-6);
}

/// y makes up for x along a steep valley that a bound of y cuts: a step clipped there would leave it.
TEST(SearchTeam, StepsAlongABound) {
  Surface valley(
      2,
      [](const VectorXd& x) {
        return makeVector({100.0 * (x[0] + x[1]), x[0] - 3.0 * x[1]});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.05, makeVector({-0.6, 1.2}));
  SearchTeam team(valley.surface, makeVector({0.8, -0.8}));
  team.run(8);
  EXPECT_EQ(team.getLocal(0).at[1], 1.0);
  EXPECT_NEAR(team.getLocal(0).at[0], -0.4, 1e-3);
}

TEST(BoundTest, NamesWhatFitsBestBeyondABound) {
  const auto test = [](double truth) {
    Surface bounded(
        2,
        [](const VectorXd& x) {
          return makeVector({x[0] + x[1], x[1]});
        },
        testing::makeParameters(2, -1.0, 1.0), 0.05, makeVector({truth, 0.2}));
    SearchTeam team(bounded.surface, makeVector({0.0, 0.0}));
    team.run(20);
    return findBeyondBounds(team.getLocal(0));
  };
  EXPECT_EQ(test(1.5), std::vector<Index>{0});  // 7 standard deviations of the noise of both together
  EXPECT_TRUE(test(1.05).empty());
  EXPECT_TRUE(test(0.9).empty());
}

TEST(SearchTeam, EndsInABasinThatIsKnown) {
  Surface cubic(
      2,
      [](const VectorXd& x) {
        return makeVector({x[0] + 2.0 * x[0] * x[0] * x[0], x[1] - 0.5 * x[0] * x[0]});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.02, makeVector({0.2, 0.3}));
  const VectorXd minimum = makeVector({0.2, 0.3});
  const auto search = [&](const std::vector<Basin>& known) {
    const int before = cubic.surface.getSimulations();
    SearchTeam team(cubic.surface, makeVector({-0.7, 0.9}));
    team.setKnown(known);
    team.run(25);
    return std::pair(cubic.surface.getSimulations() - before, team.getLocal(0).at);
  };
  const auto [alone, found] = search({});
  EXPECT_LT((found - minimum).norm(), 1e-3);
  const auto [fewer, end] = search(cubic.makeBasins(minimum));
  EXPECT_LT(fewer, alone);
  EXPECT_EQ(end, minimum);  // taken from the basin, not found anew
}

}  // namespace
}  // namespace twinmap
