// The signals are closed forms, of which samples are taken away: what the bridge errs by is known.
#include "framework/data/measurement/bridged_gaps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {
namespace {

constexpr double kStep = 0.01;
using Function = std::function<double(double)>;

/// 4 s of it without these samples.
TableSpec sample(const Function& f, const std::set<int>& lost, TableInterpolation interpolation) {
  TableSpec table;
  table.interpolation = interpolation;
  table.measured.emplace();
  for (int i = 0; i <= 400; ++i) {
    if (lost.count(i) == 0) {
      table.times.push_back(kStep * i);
      table.values.push_back(f(kStep * i));
    }
  }
  return table;
}

TableSpec bridge(TableSpec table) {
  bridgeGaps(table, "a.csv", 0.0, 0.0, 4.0);
  return table;
}

double calcStddev(const TableSpec& table, std::size_t value) {
  double variance = 0.0;
  for (const TableUnknown& unknown : table.unknown) {
    if (value >= unknown.first && value < unknown.first + unknown.changes.size()) {
      variance += unknown.changes[value - unknown.first] * unknown.changes[value - unknown.first];
    }
  }
  return std::sqrt(variance);
}

double sine(double t) {
  return std::sin(12.0 * t);
}

TEST(BridgedGaps, OfALinearSignalErrByItsCurvature) {
  const TableSpec table = bridge(sample(sine, {100}, TableInterpolation::kLinear));
  ASSERT_EQ(table.times.size(), 401U);
  EXPECT_NEAR(table.times[100], 1.0, 1e-12);
  EXPECT_NEAR(table.values[100], 0.5 * (sine(0.99) + sine(1.01)), 1e-12);
  // f'' h^2 / 2, its root mean square over a period, 52 samples; fifty on either side are looked at
  EXPECT_NEAR(calcStddev(table, 100), 144.0 * kStep * kStep / 2.0 / std::sqrt(2.0), 1e-3 * 0.5);
  EXPECT_NE(table.bridged.find("1 of its samples"), std::string::npos);
}

TEST(BridgedGaps, OfASplineErrByLess) {
  const TableSpec linear = bridge(sample(sine, {100, 101}, TableInterpolation::kLinear));
  const TableSpec cubic = bridge(sample(sine, {100, 101}, TableInterpolation::kCubic));
  EXPECT_LT(calcStddev(cubic, 100), 0.05 * calcStddev(linear, 100));
  EXPECT_LT(std::abs(cubic.values[100] - sine(1.0)), 4.0 * calcStddev(cubic, 100));
}

double stairs(double t) {
  constexpr double kLevels[] = {1.0, -2.0, 0.5, 3.0};
  return kLevels[static_cast<int>(std::floor(t / 0.07 + 1e-9)) % 4];
}

TEST(BridgedGaps, OfAHeldSignalBetweenEqualValuesHideNothing) {
  const TableSpec table = bridge(sample(stairs, {73}, TableInterpolation::kHold));
  EXPECT_EQ(table.values[73], stairs(0.73));
  EXPECT_TRUE(table.unknown.empty());
}

TEST(BridgedGaps, OfAHeldSignalThatChangesHideWhen) {
  const TableSpec table = bridge(sample(stairs, {70}, TableInterpolation::kHold));
  const double change = stairs(0.705) - stairs(0.695);
  EXPECT_NEAR(table.values[70], stairs(0.695) + 0.5 * change, 1e-12);
  EXPECT_NEAR(calcStddev(table, 70), 0.5 * std::abs(change), 1e-9);
}

TEST(BridgedGaps, ALateSampleOfAHeldSignalIsOne) {
  TableSpec table = sample(stairs, {}, TableInterpolation::kHold);
  table.times[70] += 0.004;  // the first one after a change
  const TableSpec bridged = bridge(table);
  ASSERT_EQ(bridged.times.size(), 402U);
  EXPECT_NEAR(bridged.times[70], 0.70, 1e-9);
  EXPECT_EQ(bridged.values[70], stairs(0.705));
  EXPECT_NEAR(calcStddev(bridged, 70), 0.5 * std::abs(stairs(0.705) - stairs(0.695)), 1e-9);
  EXPECT_EQ(bridge(sample(sine, {}, TableInterpolation::kLinear)).bridged, "");
}

std::string getError(TableSpec table) {
  try {
    bridgeGaps(table, "a.csv", 0.0, 0.0, 4.0);
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "none";
}

TEST(BridgedGaps, AreRefusedByLength) {
  std::set<int> most;
  for (int i = 5; i < 395; ++i) {
    most.insert(i);
  }
  EXPECT_NE(getError(sample(sine, most, TableInterpolation::kLinear)).find("too long"), std::string::npos);
  TableSpec table = sample(sine, {100, 101}, TableInterpolation::kLinear);
  table.measured->max_gap = 0.025;
  EXPECT_NE(getError(table).find("a.csv: has a gap of 0.03 s after t = 0.99 s"), std::string::npos);
  table.measured->max_gap = 0.035;
  EXPECT_EQ(getError(table), "none");
}

}  // namespace
}  // namespace twinmap
