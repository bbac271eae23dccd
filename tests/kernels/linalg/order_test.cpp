#include "kernels/linalg/order.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

using Eigen::Index;

TEST(Order, ListsIndicesFromTheFirst) {
  EXPECT_EQ(listIndices(Index{3}), (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(listIndices(Index{2}, Index{5}), (std::vector<Index>{5, 6}));
  EXPECT_TRUE(listIndices(std::size_t{0}).empty());
}

TEST(Order, SortsByWhatComesBeforeAndKeepsTheLowerOfTwoAlike) {
  const Eigen::Vector4d values(2.0, 1.0, 2.0, 0.5);
  const auto descends = [&](Index a, Index b) { return values[a] > values[b]; };
  EXPECT_EQ(sortIndices(values.size(), descends), (std::vector<Index>{0, 2, 1, 3}));
}

TEST(Order, MedianIsTheUpperOfTwoMiddleValuesAndLeavesThemInTheirOrder) {
  const Eigen::VectorXd values = Eigen::Vector4d(4.0, 1.0, 3.0, 2.0);
  EXPECT_EQ(calcMedian(values), 3.0);
  EXPECT_EQ(values, Eigen::Vector4d(4.0, 1.0, 3.0, 2.0));
  EXPECT_EQ(calcMedian(std::vector<int>{7, 9, 8}), 8);
  EXPECT_EQ(calcMedian(std::vector<double>{}), 0.0);
}

}  // namespace
}  // namespace twinmap
