#include "framework/estimation/posterior/basins/straight_ridge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Surface;

/// The shape of the ridge on which a truth within [0.5, 5] lies.
RidgeShape findShape(testing::Response response, const VectorXd& truth) {
  constexpr double kNoise = 0.02;
  const auto times = static_cast<int>(response(truth).size());
  Surface made(times, response, testing::makeParameters(static_cast<int>(truth.size()), 0.5, 5.0), kNoise,
               truth);
  return findRidgeShape(made.surface, made.makeBasins(made.coordinates.fromParameters(truth)).front());
}

TEST(StraightRidge, TakesTheTermsOfASumAsTheyAre) {
  const RidgeShape shape = findShape(
      [](const VectorXd& x) { return VectorXd::Constant(20, x[0] + 2.0 * x[1]); }, makeVector({1.0, 2.0}));
  EXPECT_EQ(shape.plain, (std::vector<Index>{0, 1}));
  EXPECT_TRUE(shape.is_straight);
}

TEST(StraightRidge, LeavesProductsAndQuotientsInLogarithms) {
  const RidgeShape shape =
      findShape([](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[1] / x[2]); },
                makeVector({1.0, 2.0, 1.5}));
  EXPECT_TRUE(shape.plain.empty());
  EXPECT_TRUE(shape.is_straight);
}

TEST(StraightRidge, TellsASumFromAProductBesideIt) {
  const RidgeShape shape = findShape(
      [](const VectorXd& x) {
        return makeVector({x[0] * x[1], x[2] + x[3], x[4]});
      },
      makeVector({1.0, 2.0, 1.5, 2.5, 3.0}));
  EXPECT_EQ(shape.plain, (std::vector<Index>{2, 3}));
  EXPECT_TRUE(shape.is_straight);
}

TEST(StraightRidge, SaysWhereNeitherIsStraight) {
  const RidgeShape shape =
      findShape([](const VectorXd& x) { return VectorXd::Constant(20, x[0] * x[0] + x[1] * x[1]); },
                makeVector({2.0, 2.5}));
  EXPECT_FALSE(shape.is_straight);
}

TEST(StraightRidge, IsStraightWhereAllIsDetermined) {
  const RidgeShape shape = findShape([](const VectorXd& x) { return VectorXd(x); }, makeVector({1.0, 2.0}));
  EXPECT_TRUE(shape.plain.empty());
  EXPECT_TRUE(shape.is_straight);
}

TEST(LevelBasin, ReachesBothEndsOfARidgeFromOneOfThem) {
  // x[0] + x[1] = 0 within [-1, 1]: from (-1, 1) to (1, -1), uniform along it
  Surface sum(
      20, [](const VectorXd& x) { return VectorXd::Constant(20, x[0] + x[1]); },
      testing::makeParameters(2, -1.0, 1.0), 0.02, makeVector({0.0, 0.0}));
  const Basin level = levelBasin(sum.makeBasins(makeVector({0.95, -0.95})).front());
  EXPECT_NEAR(level.local.at[0], 0.0, 1e-3);
  EXPECT_NEAR(level.local.at[1], 0.0, 1e-3);
  EXPECT_NEAR(std::sqrt(level.covariance(0, 0)), 2.0 / std::sqrt(12.0), 2e-3);
}

TEST(LevelBasin, LeavesWhatTheMeasurementDetermines) {
  Surface straight(
      2, [](const VectorXd& x) { return VectorXd(x); }, testing::makeParameters(2, -1.0, 1.0), 0.05,
      makeVector({0.2, 0.3}));
  const Basin basin = straight.makeBasins(makeVector({0.2, 0.3})).front(), level = levelBasin(basin);
  EXPECT_EQ(level.local.at, basin.local.at);
  EXPECT_TRUE(level.covariance.isApprox(basin.covariance, 1e-12));
}

}  // namespace
}  // namespace twinmap
