#include "framework/data/measurement/look.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// 4 s at 100 Hz of a sine of 1 Hz, with noise of sd .01.
Table recordSine() {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0.0, 0.01);
  const VectorXd times = VectorXd::LinSpaced(401, 0.0, 4.0);
  return {"m.csv",
          {{"t", {}, times}, {"x", "mm", times.unaryExpr([&](double t) {
                                return std::sin(6.283185307179586 * t) + normal(generator);
                              })}},
          {}};
}

ColumnLook lookAtSine(const Table& table) {
  return look(table, {}).columns.at(0);
}

TEST(Look, FindsRateRangeAndNoise) {
  const TableLook looked = look(recordSine(), {});
  EXPECT_EQ(looked.time, "t");
  EXPECT_EQ(looked.rows, 401);
  EXPECT_EQ(looked.last, 4.0);
  const ColumnLook& x = looked.columns.at(0);
  EXPECT_EQ(x.unit, "mm");
  EXPECT_NEAR(x.step, 0.01, 1e-12);
  EXPECT_LT(x.step_spread, 1e-9);
  EXPECT_NEAR(x.largest, 1.0, 0.05);
  EXPECT_NEAR(x.noise, 0.01, 0.0015);  // 400 samples
  EXPECT_EQ(x.missing + x.gaps.count + x.spikes.count + x.at_least.count + x.at_largest.count + x.turns.count,
            0);
  EXPECT_EQ(x.resolution, 0.0);
}

// As MATLAB's files hold them.
TEST(Look, LeavesOutSettingsBesideTheRecording) {
  Table table = recordSine();
  table.columns.insert(table.columns.begin(), {"gain", {}, VectorXd::Constant(1, 35.0)});
  const TableLook looked = look(table, {});
  EXPECT_EQ(looked.rows, 401);
  ASSERT_EQ(looked.columns.size(), 1U);
  ASSERT_EQ(looked.skipped.size(), 1U);
  EXPECT_EQ(looked.skipped[0].reason, "m.csv: column 'gain' is a single number, 35");
}

TEST(Look, FindsWhatIsMissing) {
  Table table = recordSine();
  table.columns[1].values.segment(200, 3).setConstant(kUnknown);
  table.columns[1].values[50] = kUnknown;
  const ColumnLook x = lookAtSine(table);
  EXPECT_EQ(x.missing, 4);
  EXPECT_EQ(x.gaps.count, 2);
  EXPECT_NEAR(x.gaps.first, 0.49, 1e-12);
  EXPECT_NEAR(x.longest_gap, 0.04, 1e-12);
}

TEST(Look, FindsSpikesClippingAndTurns) {
  Table table = recordSine();
  table.columns[1].values[120] += 0.5;
  table.columns[1].values[300] -= 4.0;
  EXPECT_EQ(lookAtSine(table).spikes.count, 2);
  EXPECT_NEAR(lookAtSine(table).spikes.first, 1.2, 1e-12);
  table = recordSine();
  table.columns[1].values = table.columns[1].values.cwiseMin(0.8);
  EXPECT_GT(lookAtSine(table).at_largest.count, 50);
  EXPECT_EQ(lookAtSine(table).at_least.count, 0);
  table = recordSine();
  table.columns[1].unit = "deg";
  table.columns[1].values =
      table.columns[0].values.unaryExpr([](double t) { return std::remainder(200.0 * t, 360.0); });
  EXPECT_EQ(lookAtSine(table).turns.count, 2);
  EXPECT_EQ(lookAtSine(table).turn, 360.0);
}

TEST(Look, TakesAnEncoderForWhatItIs) {
  Table table = recordSine();
  table.columns[1].values = (table.columns[1].values.array() * 20.0).round() / 20.0;
  const ColumnLook x = lookAtSine(table);
  EXPECT_NEAR(x.resolution, 0.05, 1e-12);
  EXPECT_EQ(x.at_least.count + x.at_largest.count + x.spikes.count, 0);
}

/// A column over 4 s at 100 Hz.
ColumnLook lookAtValues(const std::function<double(double)>& calc) {
  const VectorXd times = VectorXd::LinSpaced(401, 0.0, 4.0);
  return look({"m.csv", {{"t", {}, times}, {"x", {}, times.unaryExpr(calc)}}, {}}, {}).columns.at(0);
}

Index countOdd(const ColumnLook& x) {
  return x.at_least.count + x.at_largest.count + x.spikes.count;
}

TEST(Look, TakesFlatTopsAndStepsForWhatTheyAre) {
  const auto round = [](double value, double step) { return std::round(value / step) * step; };
  const auto square = [](double t) { return std::fmod(t, 1.0) < 0.5 ? 1.0 : -1.0; };
  EXPECT_EQ(countOdd(lookAtValues(square)), 0);
  EXPECT_EQ(countOdd(lookAtValues([](double t) { return std::min(3.0, std::floor(t)); })), 0);  // stairs
  EXPECT_EQ(countOdd(lookAtValues([&](double t) { return round(std::sin(3.0 * t), 0.002); })), 0);
  // rests, then moves: steps of a counter
  EXPECT_EQ(countOdd(lookAtValues([&](double t) { return round(t < 2.2 ? 0.0 : 0.3 * (t - 2.2), 0.01); })),
            0);
  EXPECT_GT(lookAtValues([](double t) { return std::min(0.8, std::sin(3.0 * t)); }).at_largest.count, 20);
  EXPECT_GT(
      lookAtValues([&](double t) { return round(std::max(-0.5, std::sin(5.0 * t)), 0.001); }).at_least.count,
      20);
}

TEST(Look, TellsTwoSamplesThatComeBackFromAStep) {
  const ColumnLook x =
      lookAtValues([](double t) { return std::abs(t - 2.005) < 0.008 ? 1.0 : 0.001 * std::sin(t); });
  EXPECT_EQ(x.spikes.count, 1);
}

TEST(Look, TellsDoubleTriggersOfACounterAndThePlaceOfEachGap) {
  std::vector<double> stamps{0.0};
  for (int turn = 1; turn < 300; ++turn) {  // a wheel that slows down, and fires twice each 50 turns
    stamps.push_back(stamps.back() + 0.1 + 0.002 * turn);
    if (turn % 50 == 0) {
      stamps.push_back(stamps.back() + 0.0016);
    }
  }
  const auto count = static_cast<Index>(stamps.size());
  const VectorXd times = Eigen::Map<const VectorXd>(stamps.data(), count);
  const Table table{"m.csv", {{"t", {}, times}, {"q", {}, VectorXd::LinSpaced(count, 0.0, 1.0)}}, {}};
  const ColumnLook q = look(table, {}).columns.at(0);
  EXPECT_EQ(q.short_steps.count, 5);
  EXPECT_NEAR(q.shortest_step, 0.0016, 1e-9);
  EXPECT_EQ(q.gaps.times.size(), static_cast<std::size_t>(q.gaps.count));
  EXPECT_NE(makeLookText(look(table, {})).find("5 short steps"), std::string::npos);
  EXPECT_NE(makeLookJson(look(table, {})).find("\"at\": ["), std::string::npos);
}

TEST(Look, GuessesTheTimesAndSortsThem) {
  Table table = recordSine();
  table.columns[0].name = "stamp";
  EXPECT_TRUE(look(table, {}).time_was_guessed);
  table.columns[0].values.row(7).swap(table.columns[0].values.row(8));
  EXPECT_THROW(look(table, {}), MeasurementError);
  const TableLook looked = look(table, {ColumnSpec{"stamp", {}, {}}, {}, 0.0});
  EXPECT_EQ(looked.remarks.size(), 1U);
  EXPECT_EQ(look(table, {{}, 50.0, 0.0}).last, 8.0);
}

TEST(Look, SaysInWordsWhatStandsOut) {
  Table table = recordSine();
  table.columns[1].values[300] -= 4.0;
  table.columns[1].values[50] = kUnknown;
  const std::string text = makeLookText(look(table, {}));
  EXPECT_NE(text.find("m.csv: 401 rows, 0 s to 4 s"), std::string::npos) << text;
  EXPECT_NE(text.find("1 missing in 1 gap (0.49 s), the longest 0.02 s; 1 spike (3 s)"), std::string::npos)
      << text;
}

TEST(Look, SaysOnceWhatIsMissingInGaps) {
  Table table = recordSine();
  table.columns[1].values[50] = kUnknown;
  table.columns[1].values.segment(200, 3).setConstant(kUnknown);
  std::string text = makeLookText(look(table, {}));
  EXPECT_NE(text.find("4 missing in 2 gaps (0.49 s, 1.99 s), the longest 0.04 s"), std::string::npos) << text;
  table.columns[0].values.tail(100).array() += 0.5;  // a gap of the recorder holds no rows
  text = makeLookText(look(table, {}));
  EXPECT_NE(text.find("4 missing; 3 gaps (0.49 s, 1.99 s, 3 s), the longest 0.51 s"), std::string::npos)
      << text;
  table = recordSine();
  table.columns[1].values[0] = kUnknown;  // not a gap: no sample stands before it
  text = makeLookText(look(table, {}));
  EXPECT_NE(text.find("1 missing\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace twinmap
