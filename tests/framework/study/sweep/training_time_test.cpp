#include "framework/study/sweep/training_time.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/study/sweep/case_cost.hpp"

namespace twinmap {
namespace {

ExperimentSpec load(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "inverse_map={gp: {}}");
  return loadExperiment(std::string(TWINMAP_SOURCE_DIR) + "/experiments/duffing/cart.yaml", overrides);
}

TEST(TrainingTime, GoesThroughTheMeasurementsAndGrowsWithTheCubeBeyond) {
  const TrainingTime time{{{100, 1e-3}, {200, 4e-3}, {400, 32e-3}}, 10.0, 10.0};
  EXPECT_DOUBLE_EQ(time.calcEvaluation(200), 4e-3);
  EXPECT_NEAR(time.calcEvaluation(150), 1e-3 * 1.5 * 1.5, 1e-12);  // the square between the first two
  EXPECT_NEAR(time.calcEvaluation(300), 4e-3 * 3.375, 1e-12);      // the cube between the last two
  EXPECT_NEAR(time.calcEvaluation(800), 32e-3 * 8, 1e-12);
  EXPECT_NEAR(time.calcEvaluation(50), 0.5e-3, 1e-12);
}

TEST(TrainingTime, CountsParametersSearchesAndTheSearchOnAllDraws) {
  const TrainingTime time{{{100, 1e-3}, {1000, 1.0}}, 10.0, 20.0};
  const std::string size = "design.train.samples=100";
  // 3 parameters, 2 starts
  EXPECT_NEAR(time.calcTraining(load({size, "noise.replicates=1", "inverse_map.gp.length_scales=shared"})),
              3 * 2 * 10 * 1e-3, 1e-12);
  // 2 more to find a shared length scale; then one search on 1000 columns
  EXPECT_NEAR(time.calcTraining(load({size, "noise.replicates=1"})), 3 * 4 * 10 * 1e-3, 1e-12);
  EXPECT_NEAR(time.calcTraining(load({size, "noise.replicates=10"})), 3 * 4 * 10 * 1e-3 + 3 * 20 * 1.0, 1e-9);
}

// 1000 samples with 3 draws: searched with 2 of them, fitted to 3000 columns for a third of an evaluation.
TEST(TrainingTime, CountsAFitToAllDrawsAfterASearchOnFewer) {
  const TrainingTime time{{{100, 1e-3}, {1000, 1.0}}, 10.0, 20.0};
  EXPECT_NEAR(time.calcTraining(load({"design.train.samples=1000", "noise.replicates=3"})),
              3 * 4 * 10 * 1.0 + 3 * 20 * 8.0 + 3 * 27.0 / 3, 1e-9);
}

TEST(CaseCost, GrowsWithSquareAndCube) {
  const auto cost = [](int samples, int threads) {
    return calcCaseCost(load({"noise.replicates=1", "design.train.samples=" + std::to_string(samples)}),
                        threads);
  };
  EXPECT_NEAR(cost(8000, 1).flops / cost(4000, 1).flops, 8.0, 1e-9);
  EXPECT_NEAR(cost(80000, 1).bytes / cost(40000, 1).bytes, 4.0, 0.1);
  EXPECT_GT(cost(4000, 2).bytes, cost(4000, 1).bytes);
  EXPECT_LT(calcCaseCost(load({"design.train.samples=20000", "inverse_map.gp.approximation=sgpr"}), 1).bytes,
            0.1 * cost(20000, 1).bytes);
}

/// Two outputs of the two beams, each sampled so often, with noise that is coupled or independent.
ExperimentSpec loadSampled(int count, bool coupled = true) {
  std::vector<std::string> overrides{
      "design.train.samples=60", "design.test.samples=20",
      "features=[{samples: {outputs: [y, theta], start: 0.0001, interval: 0.0001, count: " +
          std::to_string(count) + "}}]"};
  if (coupled) {
    overrides.emplace_back("noise.correlation={y: {autoregression: [0.5], sample_time: 0.0001}}");
  }
  return loadExperiment(std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/table1.yaml", overrides);
}

// As measured: 96 MB for 1000 features and 287 MB for 2000, of which the program takes 36; 23 GiB for 20000.
TEST(CaseCost, CountsTheCovarianceOfTheFeaturesNoise) {
  const auto cost = [](int count) { return calcCaseCost(loadSampled(count), 2).bytes; };
  EXPECT_NEAR(cost(500), 62e6, 12e6);
  EXPECT_NEAR(cost(1000), 250e6, 30e6);
  EXPECT_NEAR(cost(10000) / kGibibyte, 23.5, 1.5);
  EXPECT_LT(calcCaseCost(loadSampled(10000, false), 2).bytes, 2 * kGibibyte);
}

TEST(RequireMemory, RefusesWithWhatIsNeededAvailableAndToBeReduced) {
  EXPECT_NO_THROW(requireMemory(loadSampled(10000), 2, 32 * kGibibyte));
  EXPECT_NO_THROW(requireMemory(loadSampled(100), 2, 0.1 * kGibibyte));
  try {
    requireMemory(loadSampled(10000), 2, 16 * kGibibyte);
    FAIL() << "20000 features in 16 GiB";
  } catch (const ExperimentError& error) {
    const std::string text = error.what();
    for (const char* part :
         {"needs about 2", "20000 features", "16 GiB are available", "fewer samples of the outputs"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
  }
  EXPECT_THROW(requireMemory(load({"design.train.samples=20000"}), 1, kGibibyte), ExperimentError);
}

TEST(AvailableMemory, KeepsToTheLimitOfTheProcess) {
  EXPECT_GT(getAvailableMemory(), 0.0);
  EXPECT_LE(getAvailableMemory(), getMachineMemory());
#ifndef __SANITIZE_ADDRESS__  // it maps terabytes for its own, which no limit leaves room for
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  constexpr rlim_t kLimit = 1U << 30U;
  const rlimit lowered{kLimit, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &lowered), 0);
  EXPECT_LE(getAvailableMemory(), static_cast<double>(kLimit));
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
#endif
}

}  // namespace
}  // namespace twinmap
