#include "framework/study/sweep/training_time.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/experiment_file.hpp"
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

}  // namespace
}  // namespace twinmap
