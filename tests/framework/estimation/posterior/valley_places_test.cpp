#include "framework/estimation/posterior/draws/valley_places.hpp"

#include <gtest/gtest.h>

#include "framework/estimation/posterior/draws/floor_draws.hpp"
#include "framework/estimation/posterior/draws/posterior_draws.hpp"
#include "tests/framework/estimation/posterior/surface.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::makeVector;
using testing::Surface;

TEST(ValleyPlaces, LieOnAllOfABentFloorWhereverItsDeepestPointIs) {
  Surface banana(
      2,
      [](const VectorXd& x) {
        return makeVector({0.05 * x[0], 8.0 * (x[1] - x[0] * x[0])});
      },
      testing::makeParameters(2, -1.0, 1.0), 0.1, makeVector({-1.0, 1.0}));
  const auto places = findValleyPlaces(banana.surface, banana.makeBasins(makeVector({-1.0, 1.0})), 1);
  double first = 0.0, last = 0.0;
  for (const LocalSurface& place : places) {
    first = std::min(first, place.at[0]);
    last = std::max(last, place.at[0]);
    EXPECT_NEAR(place.at[1], place.at[0] * place.at[0], 0.1 / 8.0);  // one standard deviation of the noise
  }
  EXPECT_LT(first, -0.75);
  EXPECT_GT(last, 0.75);
}

TEST(ValleyPlaces, AreNoneThatDoNotFit) {
  Surface known(
      2, [](const VectorXd& x) { return VectorXd(x); }, testing::makeParameters(2, -1.0, 1.0), 0.01,
      makeVector({0.3, 0.1}));
  EXPECT_TRUE(findValleyPlaces(known.surface, known.makeBasins(makeVector({0.3, 0.1})), 1).empty());
}

/// A bent valley, and a parameter beside it that is none: the distance from the valley is normal, the
/// parameter is half of that, cut off at its bound.
TEST(DrawsAcrossValleys, SayWhatIsDeterminedAndHowWell) {
  constexpr double kNoise = 0.1, kAcross = kNoise / 8.0, kBeside = kNoise / 5.0;
  std::vector<ParameterSpec> parameters = testing::makeParameters(3, -1.0, 1.0);
  parameters[2].bounds.lower = 0.0;
  Surface banana(
      3,
      [](const VectorXd& x) {
        return makeVector({0.05 * x[0], 8.0 * (x[1] - x[0] * x[0]), 5.0 * x[2]});
      },
      parameters, kNoise, makeVector({-1.0, 1.0, 0.0}));
  const std::vector<LocalSurface> places =
      findValleyPlaces(banana.surface, banana.makeBasins(makeVector({-1.0, 1.0, -1.0})), 1);
  const FloorDraws draws = drawAcrossValleys(places, banana.coordinates, 1);
  ASSERT_TRUE(draws.isGiven());
  const auto expect = [&](const VectorXd& values, double mean, double stddev) {
    EXPECT_TRUE(draws.determine(values));
    const double found = draws.weights.dot(values);
    EXPECT_NEAR(found, mean, 0.1 * stddev);
    EXPECT_NEAR(std::sqrt(draws.weights.dot((values.array() - found).square().matrix())), stddev,
                0.08 * stddev);
  };
  const VectorXd bend = draws.points.row(0).cwiseAbs2();
  expect(draws.points.row(1).transpose() - bend, 0.0, kAcross);
  expect(draws.points.row(2), kBeside * std::sqrt(2.0 / M_PI), kBeside * std::sqrt(1.0 - 2.0 / M_PI));
  for (const Index along : {0, 1}) {
    EXPECT_FALSE(draws.determine(draws.points.row(along))) << along;
  }
  // with a part that the valley leaves open: of .577 half-widths, a hundredth and half of the variance across
  const VectorXd across = draws.points.row(1).transpose() - bend, along = draws.points.row(0);
  EXPECT_TRUE(draws.determine(across + 0.1 * kAcross / 0.577 * along));
  EXPECT_FALSE(draws.determine(across + 0.7 * kAcross / 0.577 * along));
  const FloorDraws of_one = drawAcrossValleys({places.front()}, banana.coordinates, 1);
  EXPECT_FALSE(of_one.determine(of_one.points.row(2)));  // one place shows no valley
}

/// Two bent ridges that meet in a corner of six dimensions, where chi-square is least: draws about it alone
/// look as good as those of all. Of x3, x4, x5 nothing is known but that they are rather 1 than -1:
/// exp(-(1.5 - x)^2 s / 2) cut off at the bounds is the oracle.
TEST(DrawsAlongWalks, LeaveACornerOfTheBox) {
  constexpr double kNoise = 0.1, kWeak = 0.06;
  Surface corner(
      5,
      [=](const VectorXd& x) {
        return makeVector({2.0 * (x[0] - x[1] * x[3]), 2.0 * (x[2] - x[4] * x[5]), kWeak * x[3], kWeak * x[4],
                           kWeak * x[5]});
      },
      testing::makeParameters(6, -1.0, 1.0), kNoise, makeVector({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}));
  const std::vector<Basin> basins = corner.makeBasins(VectorXd::Ones(6));
  const importance::AdaptiveDraws drawn = drawAlongWalks(corner.surface, basins, {});
  ASSERT_TRUE(drawn.isReliable());
  const VectorXd mean = importance::calcMean(drawn.draws);
  const MatrixXd covariance = importance::calcCovariance(drawn.draws);
  double sum = 0.0, first = 0.0, second = 0.0;
  for (double x = -0.9995; x < 1.0; x += 0.001) {
    const double density = std::exp(-0.5 * std::pow(kWeak * (x - 1.0) / kNoise, 2));
    sum += density;
    first += density * x;
    second += density * x * x;
  }
  const double expected = first / sum, stddev = std::sqrt(second / sum - expected * expected);
  for (const Index j : {3, 4, 5}) {
    EXPECT_NEAR(mean[j], expected, 0.25 * stddev) << j;
    EXPECT_NEAR(std::sqrt(covariance(j, j)), stddev, 0.2 * stddev) << j;
  }
}

}  // namespace
}  // namespace twinmap
