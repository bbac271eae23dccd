#include "framework/data/noise/signal_noise.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kTimes = 1000;

Table makeNoisyTable() {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Table table{
      "a.csv",
      {{"t", {}, VectorXd(kTimes)}, {"y", "mm", VectorXd(kTimes)}, {"still", {}, VectorXd::Ones(kTimes)}},
      {}};
  for (Index i = 0; i < kTimes; ++i) {
    table.columns[0].values[i] = 0.01 * static_cast<double>(i);
    table.columns[1].values[i] = (i < kTimes / 2 ? 1.0 : 50.0) * normal(generator);
  }
  return table;
}

std::string getNoiseError(const Table& table, const NoiseQuestion& question) {
  try {
    estimateNoise(table, question);
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SignalNoise, IsThatOfTheWindowInTheUnitThatIsAskedFor) {
  NoiseQuestion question;
  question.window = {0.0, 4.99};
  question.columns = {{"out", {"y", {}, {}}, "m"}};
  const std::vector<SignalNoise> signals = estimateNoise(makeNoisyTable(), question);
  ASSERT_EQ(signals.size(), 1U);
  EXPECT_EQ(signals[0].name, "out");
  EXPECT_EQ(signals[0].unit, "m");
  EXPECT_EQ(signals[0].samples, kTimes / 2);
  EXPECT_NEAR(*signals[0].sample_time, 0.01, 1e-12);
  EXPECT_NEAR(signals[0].noise.stddev, 1e-3, 4 * signals[0].noise.stddev_error);
}

TEST(SignalNoise, OfAllColumnsLeavesOutTimesAndConstants) {
  const std::vector<SignalNoise> signals = estimateNoise(makeNoisyTable(), {});
  ASSERT_EQ(signals.size(), 1U);
  EXPECT_EQ(signals[0].name, "y");
  EXPECT_EQ(signals[0].unit, "mm");
}

TEST(SignalNoise, IsThatOfTheLongestStretchWithoutMissingCells) {
  Table table = makeNoisyTable();
  for (const Index missing : {100, 400, 700}) {
    table.columns[1].values[missing] = std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_EQ(estimateNoise(table, {})[0].samples, 299);
  NoiseQuestion question;
  question.window = {0.0, 3.49};
  const std::vector<SignalNoise> signals = estimateNoise(table, question);
  EXPECT_EQ(signals[0].samples, 249);
  EXPECT_NEAR(signals[0].noise.stddev, 1.0, 4 * signals[0].noise.stddev_error);
}

TEST(SignalNoise, ErrorsNameFileColumnAndRule) {
  Table table = makeNoisyTable();
  NoiseQuestion question;
  question.columns = {{"still", {"still", {}, {}}, ""}};
  EXPECT_EQ(getNoiseError(table, question), "a.csv: column 'still' lies on a straight line: has no noise");
  question.window = {0.0, 0.1};
  EXPECT_EQ(getNoiseError(table, question),
            "a.csv: column 'still' has 11 samples; must have at least 20 in the window");
  table.columns[0].name = "x";
  EXPECT_NE(getNoiseError(table, question).find("has no column named t or time, which a window needs"),
            std::string::npos);
  table.columns = {table.columns[2]};
  EXPECT_EQ(getNoiseError(table, {}), "a.csv: column 'still' lies on a straight line: has no noise");
}

TEST(SignalNoise, IsWrittenAsYaml) {
  SignalNoise white{"y", "m", 500, 0.01, {}}, coloured{"my theta", "rad", 500, 0.01, {}};
  white.noise.stddev = 5e-5;
  coloured.noise.stddev = 0.0151234567;
  coloured.noise.model.coefficients = {0.5, -0.25};
  EXPECT_EQ(makeNoiseYaml({white}), "noise:\n  stddev: {y: 5e-05}\n");
  EXPECT_EQ(makeNoiseYaml({white, coloured}),
            "noise:\n  stddev: {y: 5e-05, \"my theta\": 0.015123}\n  correlation:\n    \"my theta\": "
            "{autoregression: "
            "[0.5, -0.25], sample_time: 0.01}\n");
}

}  // namespace
}  // namespace twinmap
