#include "framework/estimation/posterior/valley.hpp"

#include <gtest/gtest.h>

#include "framework/estimation/posterior/search_team.hpp"
#include "tests/framework/estimation/refined/problem.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Problem;
using testing::Response;

/// A noiseless measurement and its misfit, of two parameters within [-1, 1].
struct Surface {
  Surface(int times, Response response, double noise_stddev, const VectorXd& truth)
      : unknown(testing::makeParameters(2, -1.0, 1.0)),
        problem(times, response, unknown, noise_stddev),
        features(response(truth)),
        coordinates(unknown),
        box(unknown, {0, 2}, VectorXd::Zero(2)),
        misfit(problem.simulator, problem.model, box, features),
        prior(unknown, {}),
        surface({{&misfit, &problem.model, {0, 1}}}, coordinates, prior) {}

  /// Minima that are known.
  std::vector<Basin> makeBasins(const MatrixXd& points) {
    std::vector<Basin> basins;
    for (LocalSurface& local : surface.linearize(points)) {
      MatrixXd covariance = calcBasinCovariance(local.information);
      basins.push_back({std::move(local), std::move(covariance), 3});
    }
    return basins;
  }

  const std::vector<ParameterSpec> unknown;
  Problem problem;
  const VectorXd features;
  const LogCoordinates coordinates;
  const SearchBox box;
  Misfit misfit;
  const Prior prior;
  MisfitSurface surface;
};

Surface makeBanana(double noise_stddev = 0.1) {
  return Surface(
      2,
      [](const VectorXd& x) {
        return makeVector({0.05 * x[0], 8.0 * (x[1] - x[0] * x[0])});
      },
      noise_stddev, makeVector({0.1, 0.01}));
}

TEST(Valley, FollowsTheBentFloorOfOneBasin) {
  Surface banana = makeBanana();
  const std::vector<Basin> basins = banana.makeBasins(makeVector({0.1, 0.01}));
  const Valleys valleys = followValleys(banana.surface, basins);
  ASSERT_GE(valleys.floors.size(), 2u);
  for (const Basin& floor : valleys.floors) {
    const VectorXd& at = floor.local.at;
    EXPECT_NEAR(at[1], at[0] * at[0], 0.1 / 8.0);  // one standard deviation of the noise
  }
}

TEST(Valley, ConnectsTheEndsOfABentRidge) {
  Surface banana = makeBanana();
  MatrixXd ends(2, 2);
  ends << -0.9, 0.8,  //
      0.81, 0.64;
  const Valleys valleys = followValleys(banana.surface, banana.makeBasins(ends));
  ASSERT_EQ(valleys.connected.size(), 1u);
  EXPECT_EQ(valleys.connected.front(), std::make_pair(std::size_t{0}, std::size_t{1}));
}

TEST(Valley, LeavesModesApartThatABarrierSeparates) {
  Surface mirror(
      2,
      [](const VectorXd& x) {
        return makeVector({x[0] * x[0], x[1]});
      },
      0.02, makeVector({0.6, 0.2}));
  MatrixXd modes(2, 2);
  modes << 0.6, -0.6,  //
      0.2, 0.2;
  EXPECT_TRUE(followValleys(mirror.surface, mirror.makeBasins(modes)).connected.empty());
}

TEST(Valley, LeavesAStraightOneToTheBasin) {
  Surface straight(
      2, [](const VectorXd& x) { return VectorXd(x); }, 0.05, makeVector({0.2, 0.3}));
  const Valleys valleys = followValleys(straight.surface, straight.makeBasins(makeVector({0.2, 0.3})));
  EXPECT_TRUE(valleys.floors.empty());
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
      2, [](const VectorXd& x) { return VectorXd(x); }, 0.05, makeVector({1.4, 0.3}));
  SearchTeam team(outside.surface, makeVector({0.0, 0.0}));
  team.run(20);
  EXPECT_EQ(team.getLocal(0).at[0], 1.0);
  EXPECT_NEAR(team.getLocal(0).at[1], 0.3, 1e-6);
}

}  // namespace
}  // namespace twinmap
