#include "framework/report/sections/calibration_tables.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace twinmap {
namespace {

RunFolder makeRun(const std::string& predictions) {
  RunFolder run;
  run.experiment.model.parameters.resize(1);
  run.experiment.model.parameters[0].name.text = "k";
  run.predictions = parseCsv("sample,parameter,true,inferred,stddev\n" + predictions, "predictions.csv");
  return run;
}

TEST(CalibrationTables, ReliabilityIsTheDistributionOfTheLevelsThatHoldTheTruth) {
  // |z| = 2, 1, 0 lie on the borders of the central intervals of 95.45, 68.27 and 0 %.
  const auto table = makeReliabilityTable(makeRun("4,k,0,2,1\n5,k,0,-1,1\n6,k,3,3,1\n")).toJson();
  EXPECT_EQ(table["sample"], (std::vector<int>{6, 5, 4}));
  EXPECT_NEAR(table["level"][0], 0.0, 1e-7);
  EXPECT_NEAR(table["level"][1], 0.6826895, 1e-6);
  EXPECT_NEAR(table["level"][2], 0.9544997, 1e-6);
  EXPECT_NEAR(table["observed"][0], 1.0 / 3.0, 1e-6);
  EXPECT_EQ(table["observed"][2], 1);
}

TEST(CalibrationTables, OneSampleLiesWithinTheNormalInterval) {
  const auto table = makeQuantileTable(makeRun("0,k,0,1.5,1\n")).toJson();
  EXPECT_EQ(table["quantile"][0], 0);
  EXPECT_EQ(table["z"][0], 1.5);
  EXPECT_NEAR(table["lower"][0], -1.959964, 1e-6);
  EXPECT_NEAR(table["upper"][0], 1.959964, 1e-6);
}

TEST(CalibrationTables, ScoresAreSortedAndThoseThatAreNotFiniteLeftOut) {
  const auto table = makeQuantileTable(makeRun("0,k,0,3,1\n1,k,0,1,0\n2,k,0,-3,1\n3,k,0,0,1\n")).toJson();
  EXPECT_EQ(table["sample"], (std::vector<int>{2, 3, 0}));
  EXPECT_NEAR(table["quantile"][2], 0.9674216, 1e-6);  // normal quantile of 2.5 / 3
}

TEST(CalibrationTables, TheBandIsBinomial) {
  const auto band = makeReliabilityBand(100).toJson();
  ASSERT_EQ(band["level"].size(), 51u);
  EXPECT_EQ(band["lower"][0], 0);
  EXPECT_EQ(band["upper"][50], 1);
  // 100 tosses of a coin: at most 39 heads with probability 0.0176, at most 60 with 0.9824.
  EXPECT_EQ(band["lower"][25], 0.39);
  EXPECT_EQ(band["upper"][25], 0.6);
}

}  // namespace
}  // namespace twinmap
