#include "framework/data/measurement/recording/recorded_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A recording of the cart, whose features are x at .05, .1, ... 5 s.
Table record(const VectorXd& times) {
  return {"m.csv", {{"t", {}, times}, {"x", {}, times.unaryExpr([](double t) { return std::sin(t); })}}, {}};
}

VectorXd makeTimes(double first, double step, Index count) {
  return VectorXd::NullaryExpr(count, [&](Index i) { return first + static_cast<double>(i) * step; });
}

std::optional<ExperimentSpec> follow(const Table& table, const std::vector<std::string>& overrides = {}) {
  const ExperimentSpec experiment = loadExperiment(kCart, overrides);
  return followRecordedTimes(experiment, makeLayout(experiment), table, 0.0);
}

TEST(RecordedTimes, StayThoseOfTheFeaturesWhereSamplesAreThere) {
  EXPECT_FALSE(follow(record(makeTimes(0.0, 0.05, 120))));
  EXPECT_FALSE(follow(record(makeTimes(0.0, 0.01, 600))));
}

TEST(RecordedTimes, StayWhereSomeAreMissing) {
  Table table = record(makeTimes(0.0, 0.01, 600));
  table.columns[1].values.segment(100, 5).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(follow(table));
}

TEST(RecordedTimes, AreTakenWhereFeaturesLieBetween) {
  const std::optional<ExperimentSpec> followed = follow(record(makeTimes(0.03, 0.05, 120)));
  ASSERT_TRUE(followed);
  const VectorXd times = collectTimes(followed->features);
  ASSERT_EQ(times.size(), 100);
  EXPECT_NEAR(times[0], 0.03, 1e-12);
  EXPECT_NEAR(times[99], 4.98, 1e-12);
  EXPECT_EQ(followed->features.size(), 1);
}

TEST(RecordedTimes, AreTheNearestOfAFastRecording) {
  const std::optional<ExperimentSpec> followed = follow(record(makeTimes(0.003, 0.007, 720)));
  ASSERT_TRUE(followed);
  const VectorXd times = collectTimes(followed->features);
  ASSERT_EQ(times.size(), 99);  // the nearest to 5 s is beyond the simulation's end
  for (Index i = 0; i < times.size(); ++i) {
    EXPECT_LE(std::abs(times[i] - 0.05 * static_cast<double>(i + 1)), 0.0035 + 1e-12);
  }
}

TEST(RecordedTimes, AreThoseOfStampsThatJitter) {
  VectorXd times = makeTimes(0.0, 0.05, 110);
  for (Index i = 1; i < times.size(); ++i) {
    times[i] += 0.015 * std::sin(12.9898 * static_cast<double>(i));
  }
  const std::optional<ExperimentSpec> followed = follow(record(times));
  ASSERT_TRUE(followed);
  for (const double t : collectTimes(followed->features)) {
    EXPECT_LT((times.array() - t).abs().minCoeff(), 1e-11);
  }
  EXPECT_NEAR(static_cast<double>(collectTimes(followed->features).size()), 100.0, 1.0);
}

TEST(RecordedTimes, AreNotTakenWithinTheGridOfColouredNoise) {
  const std::string coloured = "noise.correlation={x: {autoregression: [0.5]}}";
  EXPECT_TRUE(follow(record(makeTimes(0.03, 0.05, 120)), {coloured}));
  EXPECT_FALSE(follow(record(makeTimes(0.03, 0.049, 120)), {coloured}));
}

TEST(RecordedTimes, AreNotTakenForOtherFeatures) {
  EXPECT_FALSE(
      follow(record(makeTimes(0.03, 0.05, 120)),
             {"features=[{statistics: {outputs: [x], window: {start: 0.05, interval: 0.05, count: 100}, "
              "quantities: [rms]}}]"}));
}

TEST(SamplesAt, AreFewBlocksOfRoundedStamps) {
  std::vector<double> times;
  for (int i = 1; i <= 300; ++i) {
    times.push_back(std::round(1e10 * (0.011 + i / 610.35)) / 1e10);
  }
  const std::vector<FeatureSpec> blocks = makeSamplesAt("x", times);
  EXPECT_LT(blocks.size(), 3);
  const VectorXd found = collectTimes(blocks);
  ASSERT_EQ(found.size(), 300);
  for (Index i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], times[static_cast<std::size_t>(i)], 1e-7 / 610.35);
  }
}

}  // namespace
}  // namespace twinmap
