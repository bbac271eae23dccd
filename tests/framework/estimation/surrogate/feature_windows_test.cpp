#include "framework/estimation/surrogate/feature_windows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace twinmap {
namespace {

/// Every feature once, in the order of the windows.
std::vector<Eigen::Index> flatten(const std::vector<FeatureWindow>& windows) {
  std::vector<Eigen::Index> all;
  for (const FeatureWindow& window : windows) {
    all.insert(all.end(), window.begin(), window.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Eigen::Index> countUp(std::size_t count) {
  std::vector<Eigen::Index> numbers(count);
  std::iota(numbers.begin(), numbers.end(), Eigen::Index{0});
  return numbers;
}

TEST(FeatureWindows, PutAllOutputsOfNeighbouringTimesTogether) {
  std::vector<FeatureInfo> infos;
  for (const int output : {0, 1}) {
    for (int i = 0; i < 20; ++i) {
      infos.push_back({"", "m", output, 0.1 * i});
    }
  }
  const std::vector<FeatureWindow> windows = makeFeatureWindows(infos);
  ASSERT_EQ(windows.size(), 3u);  // 20 times, at most 8 a window
  EXPECT_EQ(flatten(windows), countUp(40));
  for (std::size_t w = 1; w < windows.size(); ++w) {
    for (const Eigen::Index later : windows[w]) {
      for (const Eigen::Index earlier : windows[w - 1]) {
        EXPECT_GT(infos[later].time, infos[earlier].time);
      }
    }
  }
}

TEST(FeatureWindows, KeepFeaturesWithoutATimeInOrderAndApartByOutputAndUnit) {
  std::vector<FeatureInfo> infos(20, {"", "m", 0, 0.0});
  infos.insert(infos.end(), 5, {"", "rad", 1, 0.0});
  infos.push_back({"", "m", 0, 0.5});
  const std::vector<FeatureWindow> windows = makeFeatureWindows(infos);
  EXPECT_EQ(flatten(windows), countUp(infos.size()));
  ASSERT_EQ(windows.size(), 4u);
  EXPECT_EQ(windows[0], FeatureWindow{25});
  EXPECT_EQ(windows[1].size(), 16u);
  EXPECT_EQ(windows[2], (FeatureWindow{16, 17, 18, 19}));
  EXPECT_EQ(windows[3], (FeatureWindow{20, 21, 22, 23, 24}));
}

TEST(FeatureWindows, OfUnnamedNumbersAreInOrder) {
  const std::vector<FeatureWindow> windows = makeWindowsInOrder(33);
  ASSERT_EQ(windows.size(), 3u);
  EXPECT_EQ(windows[2], FeatureWindow{32});
}

}  // namespace
}  // namespace twinmap
