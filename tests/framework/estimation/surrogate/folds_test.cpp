#include "framework/estimation/folds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace twinmap {
namespace {

using Eigen::Index;

TEST(Folds, LeaveOutEachSampleOnceAndKeepTheOthers) {
  for (const Index count : {1, 4, 10, 23}) {
    std::vector<Index> all(static_cast<std::size_t>(count)), left_out;
    std::iota(all.begin(), all.end(), Index{0});
    for (Index fold = 0; fold < 5; ++fold) {
      const std::vector<Index> out = listLeftOut(count, 5, fold), kept = listKept(count, 5, fold);
      std::vector<Index> both;
      std::merge(out.begin(), out.end(), kept.begin(), kept.end(), std::back_inserter(both));
      EXPECT_EQ(both, all);
      left_out.insert(left_out.end(), out.begin(), out.end());
    }
    std::sort(left_out.begin(), left_out.end());
    EXPECT_EQ(left_out, all);
  }
}

TEST(Folds, TakeOneOfEveryFew) {
  EXPECT_EQ(listLeftOut(10, 4, 1), (std::vector<Index>{1, 5, 9}));
  EXPECT_EQ(listKept(6, 3, 0), (std::vector<Index>{1, 2, 4, 5}));
}

}  // namespace
}  // namespace twinmap
