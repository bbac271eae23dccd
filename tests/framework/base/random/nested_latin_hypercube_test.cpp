#include "framework/base/random/nested_latin_hypercube.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/random/slices.hpp"
#include "framework/experiment/points/point_set.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;

MatrixXd sampleNested(int dimensions, int n, int smallest, std::uint64_t seed = 1) {
  return sampleNestedLatinHypercube(dimensions, n, smallest, {seed, RandomPurpose::kTrainDesign});
}

std::vector<int> countInSlices(const Eigen::RowVectorXd& points, int slices) {
  std::vector<int> count(slices, 0);
  for (Eigen::Index i = 0; i < points.size(); ++i) {
    ++count[static_cast<int>(points[i] * slices)];
  }
  return count;
}

TEST(NestedLatinHypercube, IsALatinHypercubeAtEachLevel) {
  for (const int smallest : {1, 3, 50}) {
    const MatrixXd points = sampleNested(4, 16 * smallest, smallest);
    for (int n = smallest; n <= 16 * smallest; n *= 2) {
      for (Eigen::Index d = 0; d < points.rows(); ++d) {
        EXPECT_EQ(countInSlices(points.row(d).leftCols(n), n), std::vector<int>(n, 1))
            << smallest << " " << n;
      }
    }
  }
}

RC_GTEST_PROP(NestedLatinHypercube, AnyBeginningIsBalancedInTheSlicesOfEachLevel, ()) {
  const int smallest = *rc::gen::inRange(1, 20), n = *rc::gen::inRange(1, 400);
  const MatrixXd points = sampleNested(2, n, smallest, *rc::gen::arbitrary<std::uint64_t>());
  for (int level = smallest; level <= 1000; level *= 2) {
    for (const Eigen::Index d : {0, 1}) {
      const std::vector<int> count = countInSlices(points.row(d), level);
      RC_ASSERT(*std::min_element(count.begin(), count.end()) >= n / level);
      RC_ASSERT(*std::max_element(count.begin(), count.end()) <= (n + level - 1) / level);
    }
  }
}

RC_GTEST_PROP(NestedLatinHypercube, ALongerSetBeginsWithTheShorterOneBitForBit, ()) {
  const int smallest = *rc::gen::inRange(1, 60), n = *rc::gen::inRange(1, 300);
  const MatrixXd small = sampleNested(3, n, smallest), large = sampleNested(3, 700, smallest);
  RC_ASSERT(small == large.leftCols(n));
}

// New points must not sit beside those they follow: of n more points about one shares a cell of two
// dimensions' n x n slices with an older one, if the dimensions are paired at random.
TEST(NestedLatinHypercube, NewPointsAreNotNeighboursOfOldOnes) {
  constexpr int kSize = 256;
  const MatrixXd points = sampleNested(2, 2 * kSize, 1);
  int shared = 0;
  for (int old = 0; old < kSize; ++old) {
    for (int added = kSize; added < 2 * kSize; ++added) {
      shared += findSlice(points(0, old), kSize) == findSlice(points(0, added), kSize) &&
                findSlice(points(1, old), kSize) == findSlice(points(1, added), kSize);
    }
  }
  EXPECT_LE(shared, 6);
}

TEST(NestedLatinHypercube, DimensionsAreUncorrelatedAndSeedsDiffer) {
  constexpr int kSize = 1024;
  const MatrixXd points = sampleNested(3, kSize, 1);
  const MatrixXd centred = points.colwise() - points.rowwise().mean();
  const MatrixXd correlation = centred * centred.transpose() * (12.0 / kSize);
  const double four_stddevs = 4.0 / std::sqrt(kSize);
  EXPECT_LT((correlation - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff(), four_stddevs);
  EXPECT_NE(points, sampleNested(3, kSize, 1, 2));
}

TEST(PlaceInSlice, RoundingNeverLeavesTheSlice) {
  const double almost_one = 1.0 - 0x1p-53;
  for (const int n : {1, 3, 49, 1000003}) {
    for (const int slice : {0, n / 2, n - 1}) {
      for (const double u : {0x1p-54, 0.5, almost_one}) {
        EXPECT_EQ(findSlice(placeInSlice(slice, n, u), n), slice) << n << " " << slice << " " << u;
      }
    }
  }
}

}  // namespace
}  // namespace twinmap
