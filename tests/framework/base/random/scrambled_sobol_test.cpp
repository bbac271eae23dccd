#include "framework/base/random/scrambled_sobol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "framework/base/random/standard_normal.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd draw(int dimensions, Index count, std::uint64_t seed = 1, std::uint64_t replicate = 0) {
  return drawSobol(dimensions, count, RandomStream(seed, RandomPurpose::kPosterior), 0, replicate);
}

TEST(ScrambledSobol, PutsOnePointOfAPowerOfTwoIntoEachSlice) {
  constexpr int kDimensions = 17, kCount = 512;
  const MatrixXd points = draw(kDimensions, kCount);
  for (int d = 0; d < kDimensions; ++d) {
    std::set<int> slices;
    for (Index i = 0; i < kCount; ++i) {
      ASSERT_GT(points(d, i), 0.0);
      ASSERT_LT(points(d, i), 1.0);
      slices.insert(static_cast<int>(kCount * points(d, i)));
    }
    EXPECT_EQ(slices.size(), static_cast<std::size_t>(kCount)) << d;
  }
}

TEST(ScrambledSobol, PutsOnePointIntoEachCellOfTheFirstTwoDimensions) {
  const MatrixXd points = draw(2, 256);
  std::set<std::pair<int, int>> cells;
  for (Index i = 0; i < points.cols(); ++i) {
    cells.insert({static_cast<int>(16.0 * points(0, i)), static_cast<int>(16.0 * points(1, i))});
  }
  EXPECT_EQ(cells.size(), 256u);
}

TEST(ScrambledSobol, DependsOnTheKeysAlone) {
  const MatrixXd points = draw(3, 16);
  EXPECT_EQ(points, MatrixXd(draw(5, 64).topLeftCorner(3, 16)));
  EXPECT_NE(points, draw(3, 16, 2));
  EXPECT_NE(points, draw(3, 16, 1, 1));
}

// Of 512 independent normal numbers the mean has an error of 4.4 %, the standard deviation one of 3.1 %.
TEST(ScrambledSobol, GivesNormalNumbersTheirMoments) {
  constexpr int kSeeds = 20, kDimensions = 8;
  double means = 0.0, stddevs = 0.0, corners = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const MatrixXd normals = draw(kDimensions, 512, seed).unaryExpr(&toStandardNormal);
    for (int d = 0; d < kDimensions; ++d) {
      means += std::pow(normals.row(d).mean(), 2);
      stddevs += std::pow(std::sqrt(normals.row(d).squaredNorm() / 512.0) - 1.0, 2);
    }
    corners += std::pow((normals.row(0).array() * normals.row(1).array()).mean(), 2);
  }
  EXPECT_LT(std::sqrt(means / (kSeeds * kDimensions)), 0.003);
  EXPECT_LT(std::sqrt(stddevs / (kSeeds * kDimensions)), 0.005);
  EXPECT_LT(std::sqrt(corners / kSeeds), 0.01);
}

}  // namespace
}  // namespace twinmap
