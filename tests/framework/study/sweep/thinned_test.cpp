#include "framework/study/sweep/thinned.hpp"

#include <gtest/gtest.h>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/plan.hpp"

namespace twinmap {
namespace {

ExperimentSpec loadCart(const std::string& samples) {
  return loadExperiment(std::string(TWINMAP_SOURCE_DIR) + "/experiments/duffing/cart.yaml",
                        {"features=[{samples: {outputs: [x], " + samples + "}}]"});
}

TEST(ThinnedExperiment, IsAShortOneItself) {
  const ThinnedExperiment thinned = thinSamples(loadCart("start: 0.05, interval: 0.05, count: 100"));
  EXPECT_EQ(countRecordedRows(thinned.experiment), 101.0);
  EXPECT_EQ(thinned.rows, 1.0);
  EXPECT_EQ(thinned.simulation, 1.0);
}

TEST(ThinnedExperiment, HasAThousandSamplesOverAnEighthOfTheTimeOrMore) {
  const ThinnedExperiment thinned = thinSamples(loadCart("start: 0.0005, interval: 0.0005, count: 10000"));
  const Eigen::VectorXd times = collectTimes(thinned.experiment.features);
  EXPECT_EQ(times.size(), 1000);
  EXPECT_GT(times[999], 4.9 / 8.0);  // how much more depends on the machine
  EXPECT_LT(times[999], 5.0);
  EXPECT_NEAR(thinned.rows, 10.0, 0.1);
  EXPECT_NEAR(thinned.windows, 1.0, 0.02);  // of a surrogate there are as many as there may be
  EXPECT_GT(thinned.simulation, 0.0);
}

TEST(ThinnedExperiment, KnowsTheScoresOfReducedSamplesWhichAreAllThatIsStored) {
  const ExperimentSpec reduced = loadCart("start: 0.0001, interval: 0.0001, count: 50000, reduce: automatic");
  const ThinnedExperiment thinned = thinSamples(reduced);
  EXPECT_GT(thinned.scores, 0.0);
  EXPECT_GT(thinned.reduction, 0.0);
  SweepCase one;
  one.experiment = reduced;
  ExperimentSurvey survey = surveyCases({one}, {"no_such_folder", {}});
  const double simulated = survey.stored.samples.bytes;
  survey.times.scores = thinned.scores;
  constexpr double kReport = 4e6;
  EXPECT_LT(planRun(survey, {}).disk, 0.2 * simulated + kReport);
}

}  // namespace
}  // namespace twinmap
