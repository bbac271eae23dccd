#include "framework/study/sweep/model_groups.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

const std::string kExperiments = std::string(TWINMAP_SOURCE_DIR) + "/experiments/";

std::vector<SweepCase> expand(const std::string& file, const std::vector<std::string>& overrides) {
  return expandSweep(loadExperimentTree(kExperiments + file, overrides));
}

Eigen::Index countPoints(const std::vector<SweepCase>& cases) {
  Eigen::Index count = 0;
  for (const ModelGroup& group : groupByModel(cases)) {
    count += collectPoints(cases, group, std::vector<bool>(cases.size(), true)).cols();
  }
  return count;
}

TEST(ModelGroups, SizesAndNoiseLevelsNeedTheLargestDesignAndTheTestSetOfEachSeed) {
  for (const std::string method : {"nested_latin_hypercube", "sobol"}) {
    const std::vector<SweepCase> cases = expand(
        "two_beam/table1.yaml", {"design.train.method=" + method, "design.train.samples=50,100,250,500,1000",
                                 "noise.scale=0.25,0.5,1,2", "seed=1..5"});
    EXPECT_EQ(cases.size(), 100u);
    EXPECT_EQ(countPoints(cases), (1000 + 500) * 5);
  }
}

TEST(ModelGroups, PlainLatinHypercubesOfOtherSizesAreOtherPoints) {
  EXPECT_EQ(countPoints(expand("two_beam/table1.yaml", {"design.train.samples=50,100"})), 50 + 100 + 500);
}

TEST(ModelGroups, MapsTransformsAndFeatureTimesShareAGroupModelsDoNot) {
  const std::vector<SweepCase> cases =
      expand("duffing/cart.yaml", {"features[0].samples.interval=0.02,0.05", "constants={m: 1},{m: 2}",
                                   "inverse_map.gp.covariance=matern32,matern52"});
  const std::vector<ModelGroup> groups = groupByModel(cases);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].cases, (std::vector<int>{0, 1, 4, 5}));
  EXPECT_EQ(groups[1].cases, (std::vector<int>{2, 3, 6, 7}));
  // 0.05 + 0.02 i, i < 100 and 0.05 + 0.05 i, i < 100: every fifth of the first is every second of the
  // second, where they are equal to the last bit.
  EXPECT_GE(groups[0].times.size(), 180);
  EXPECT_LE(groups[0].times.size(), 200);
  EXPECT_TRUE(std::is_sorted(groups[0].times.begin(), groups[0].times.end()));
}

TEST(ModelGroups, OfLoopsMovedBySimbodyDoNotShareTimes) {
  const std::vector<std::string> in_lanes{"features[0].samples.count=50",
                                          "features[0].samples.interval=0.01,0.02"};
  std::vector<std::string> by_simbody = in_lanes;
  by_simbody.push_back("simulation.engine=simbody");
  EXPECT_EQ(groupByModel(expand("mechanisms/slider_crank.yaml", in_lanes)).size(), 1u);
  EXPECT_EQ(groupByModel(expand("mechanisms/slider_crank.yaml", by_simbody)).size(), 2u);
}

TEST(ModelGroups, TheLongestWallTimeLimitHoldsForAll) {
  const auto groups = groupByModel(expand("duffing/cart.yaml", {"simulation.max_wall_time=5,20,10"}));
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].model.simulation.max_wall_time, 20.0);
}

}  // namespace
}  // namespace twinmap
