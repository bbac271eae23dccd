#include "framework/study/shards/shard_plan.hpp"

#include <algorithm>

#include "framework/base/text/source_location.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

constexpr const char* kCart = TWINMAP_SOURCE_DIR "/experiments/duffing/cart.yaml";

/// Of three cases, the second of them complete, and points of which some are lacking.
ExperimentSurvey makeSurvey(const std::vector<bool>& lacking) {
  ExperimentSurvey survey;
  survey.cases.resize(3);
  for (SweepCase& one : survey.cases) {
    one.experiment = loadExperiment(kCart, {});
  }
  survey.complete = {false, true, false};
  survey.times.failure = "not measured";
  survey.stored.lacking = lacking;
  return survey;
}

std::vector<Shard> takeKind(const ShardPlan& plan, ShardKind kind) {
  std::vector<Shard> taken;
  std::copy_if(plan.shards.begin(), plan.shards.end(), std::back_inserter(taken),
               [&](const Shard& shard) { return shard.kind == kind; });
  return taken;
}

/// The lacking points of each shard; the shards must follow one another from the first point to the last.
std::vector<int> countEach(const std::vector<Shard>& shards, const std::vector<bool>& lacking) {
  std::vector<int> counts;
  int next = 0;
  for (const Shard& shard : shards) {
    EXPECT_EQ(shard.first, next);
    counts.push_back(
        static_cast<int>(std::count(lacking.begin() + shard.first, lacking.begin() + shard.last, true)));
    next = shard.last;
  }
  EXPECT_EQ(next, static_cast<int>(lacking.size()));
  return counts;
}

TEST(ShardPlan, CutsWhatIsMissingEvenly) {
  std::vector<bool> lacking(100);
  for (std::size_t i = 0; i < lacking.size(); ++i) {
    lacking[i] = i > 40 && i % 5 != 0;  // 48
  }
  ShardOptions options;
  options.simulate_shards = 4;
  const ShardPlan plan = makeShardPlan(makeSurvey(lacking), options);
  EXPECT_EQ(plan.missing, 48);
  EXPECT_EQ(plan.count(ShardKind::kSimulate), 4);
  for (const int count : countEach(takeKind(plan, ShardKind::kSimulate), lacking)) {
    EXPECT_EQ(count, 12);
  }
  EXPECT_EQ(plan.train_samples.size(), 3U);
  EXPECT_EQ(plan.count(ShardKind::kFinish), 1);
  EXPECT_EQ(plan.shards.back().kind, ShardKind::kFinish);
}

TEST(ShardPlan, HasNoShardWithoutWork) {
  ShardOptions options;
  options.simulate_shards = 8;
  std::vector<bool> lacking(20);
  EXPECT_EQ(makeShardPlan(makeSurvey(lacking), options).count(ShardKind::kSimulate), 0);
  lacking[3] = lacking[19] = true;
  const ShardPlan plan = makeShardPlan(makeSurvey(lacking), options);
  EXPECT_EQ(countEach(takeKind(plan, ShardKind::kSimulate), lacking), (std::vector<int>{1, 1}));
}

TEST(ShardPlan, IsReadAsItWasWritten) {
  const TestFolder folder;
  ShardPlan plan;
  plan.store = "/a/store";
  plan.computed_with = "this processor";
  plan.portable = true;
  plan.shards = {{ShardKind::kSimulate, 0, 7}, {ShardKind::kCases, 2, 3}, {ShardKind::kFinish, 0, 0}};
  plan.train_samples = {100, 250};
  plan.missing = 7;
  plan.simulate_s = 0.1;
  plan.cases_s = 1.0 / 3.0;
  plan.memory = 5e8;
  std::filesystem::create_directories(getClusterFolder(folder.getPath()));
  writeShardPlan(folder.getPath(), plan);
  const ShardPlan read = readShardPlan(folder.getPath());
  EXPECT_EQ(read.store, plan.store);
  EXPECT_EQ(read.computed_with, plan.computed_with);
  EXPECT_TRUE(read.portable);
  EXPECT_EQ(read.train_samples, plan.train_samples);
  EXPECT_EQ(read.missing, 7);
  EXPECT_EQ(read.simulate_s, plan.simulate_s);
  EXPECT_EQ(read.cases_s, plan.cases_s);
  EXPECT_EQ(read.memory, plan.memory);
  ASSERT_EQ(read.shards.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.shards[i].kind, plan.shards[i].kind);
    EXPECT_EQ(read.shards[i].first, plan.shards[i].first);
    EXPECT_EQ(read.shards[i].last, plan.shards[i].last);
  }
}

TEST(ShardPlan, OfAFolderThatWasNotSubmittedIsAnError) {
  const TestFolder folder;
  EXPECT_THROW(readShardPlan(folder.getPath()), ExperimentError);
}

}  // namespace
}  // namespace twinmap
