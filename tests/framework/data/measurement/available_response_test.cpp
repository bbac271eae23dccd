#include "framework/data/measurement/recording/available_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "framework/data/measurement/files/time_stamp.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/measurement_start.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Outputs a and b at .1, .2, ... 2 s.
ResponseLayout makeTwoOutputs() {
  return {{"a", "b"}, {"m", "m"}, VectorXd::LinSpaced(20, 0.1, 2.0)};
}

double calcA(double t) {
  return std::sin(3.0 * t);
}
double calcB(double t) {
  return std::cos(2.0 * t);
}

/// Both, sampled every `step` s from 0 to 2.2 s.
Table record(double step) {
  const auto rows = static_cast<Index>(std::lround(2.2 / step)) + 1;
  const VectorXd times = VectorXd::NullaryExpr(rows, [&](Index i) { return static_cast<double>(i) * step; });
  return {"m.csv",
          {{"t", {}, times}, {"a", {}, times.unaryExpr(&calcA)}, {"b", {}, times.unaryExpr(&calcB)}},
          {}};
}

/// Of the rows that are there: whether each is right; returns how many are missing.
Index expectRight(const AvailableResponse& available, double tolerance) {
  const ResponseLayout layout = makeTwoOutputs();
  Index missing = 0;
  for (Index i = 0; i < layout.times.size(); ++i) {
    const double a = available.response[layout.getRow(0, i)], b = available.response[layout.getRow(1, i)];
    missing += (std::isnan(a) ? 1 : 0) + (std::isnan(b) ? 1 : 0);
    if (!std::isnan(a)) {
      EXPECT_NEAR(a, calcA(layout.times[i]), tolerance);
    }
    if (!std::isnan(b)) {
      EXPECT_NEAR(b, calcB(layout.times[i]), tolerance);
    }
  }
  EXPECT_EQ(missing, available.missing);
  return missing;
}

TEST(AvailableResponse, IsWholeWhereNothingIsMissing) {
  const AvailableResponse available = readAvailable(record(0.05), {}, makeTwoOutputs(), 0.0);
  EXPECT_EQ(expectRight(available, 1e-12), 0);
  EXPECT_TRUE(available.remarks.empty());
}

TEST(AvailableResponse, InterpolatesBetweenSamplesOfAFastColumn) {
  EXPECT_EQ(expectRight(readAvailable(record(0.04), {}, makeTwoOutputs(), 0.0), 1e-4), 0);
}

TEST(AvailableResponse, NamesAColumnWhoseNameIsSwappedWithThatOfTime) {
  Table table = record(0.1);
  std::swap(table.columns[0].name, table.columns[2].name);
  try {
    readAvailable(table, {}, makeTwoOutputs(), 0.0);
    ADD_FAILURE() << "accepted";
  } catch (const MeasurementError& error) {
    EXPECT_STREQ(error.what(),
                 "m.csv: time 't' goes back or stands in 16 of 23 rows, while 'b' rises in every one: are "
                 "the two names swapped?");
  }
}

TEST(AvailableResponse, LeavesOutEmptyCellsAndSaysWhich) {
  Table table = record(0.1);
  table.columns[1].values[3] = kNone;
  table.columns[1].values.segment(7, 4).setConstant(kNone);
  const AvailableResponse available = readAvailable(table, {}, makeTwoOutputs(), 0.0);
  EXPECT_EQ(expectRight(available, 1e-12), 5);
  ASSERT_EQ(available.remarks.size(), 1u);
  EXPECT_EQ(available.remarks[0], "5 of 20 samples of a, the longest gap 4 at 0.7 s to 1 s");
}

TEST(AvailableResponse, TakesAColumnAtALowerRateWhereItHasSamples) {
  Table table = record(0.05);
  for (Index i = 0; i < table.columns[2].values.size(); ++i) {
    table.columns[2].values[i] = i % 6 == 0 ? table.columns[2].values[i] : kNone;  // each .3 s
  }
  EXPECT_EQ(expectRight(readAvailable(table, {}, makeTwoOutputs(), 0.0), 1e-12), 14);
}

/// A feature of samples of an output, each `interval` s, from there on.
FeatureSpec sampleOf(const char* output, double interval, int count) {
  SamplesFeatureSpec samples;
  samples.outputs = {Name{output, {}}};
  samples.start = interval;
  samples.interval = interval;
  samples.count = count;
  return samples;
}

TEST(AvailableResponse, IsMissingOnlyWhereAFeatureAsksForIt) {
  Table table = record(0.1);
  for (Index i = 0; i < table.columns[2].values.size(); ++i) {
    table.columns[2].values[i] = i % 2 == 0 ? table.columns[2].values[i] : kNone;  // each .2 s
  }
  const AvailableResponse available =
      readAvailable(table, {}, makeTwoOutputs(), 0.0, {}, {sampleOf("a", 0.1, 20), sampleOf("b", 0.2, 10)});
  EXPECT_EQ(available.missing, 0);
  EXPECT_TRUE(available.remarks.empty());
}

TEST(AvailableResponse, NeedsNoColumnOfAnOutputThatNoFeatureUses) {
  Table table = record(0.1);
  table.columns.pop_back();
  const AvailableResponse available =
      readAvailable(table, {}, makeTwoOutputs(), 0.0, {}, {sampleOf("a", 0.1, 20)});
  EXPECT_EQ(available.missing, 0);
  EXPECT_THROW(readAvailable(table, {}, makeTwoOutputs(), 0.0), MeasurementError);
}

TEST(AvailableResponse, SaysThatItsSamplesLieBetween) {
  Table table = record(0.55);
  table.columns[0].values.array() += 0.01;
  try {
    readAvailable(table, {}, makeTwoOutputs(), 0.0);
    ADD_FAILURE() << "accepted";
  } catch (const MeasurementError& error) {
    EXPECT_NE(std::string(error.what()).find("but 3 between them, 0.55 s apart"), std::string::npos)
        << error.what();
  }
}

TEST(AvailableResponse, SaysWhatIsAssumedOfTimesWithoutAUnit) {
  for (const bool is_stated : {false, true}) {
    Table table = record(0.1);
    table.columns[0].values *= 1e3;
    table.columns[0].unit = is_stated ? std::optional<std::string>("s") : std::nullopt;
    try {
      readAvailable(table, {}, makeTwoOutputs(), 0.0);
      ADD_FAILURE() << "accepted";
    } catch (const MeasurementError& error) {
      const std::string said = error.what();
      EXPECT_EQ(said.find("column 't' states no unit: s is assumed") == std::string::npos, is_stated) << said;
    }
  }
}

TEST(AvailableResponse, DoesNotInterpolateOverLostRows) {
  Table table = record(0.04);
  const Index rows = table.columns[0].values.size();
  for (Column& column : table.columns) {  // .8 s to 1.2 s lost
    VectorXd left(rows - 10);
    left << column.values.head(20), column.values.tail(rows - 30);
    column.values = left;
  }
  const Index missing = expectRight(readAvailable(table, {}, makeTwoOutputs(), 0.0), 1e-4);
  EXPECT_GE(missing, 2 * 4);
  EXPECT_LE(missing, 2 * 6);
}

TEST(AvailableResponse, PutsRowsInOrderAndTakesTheFirstOfDoubles) {
  Table table = record(0.05);
  for (Column& column : table.columns) {
    column.values.segment(10, 20).reverseInPlace();
    column.values.conservativeResize(column.values.size() + 1);
    column.values.tail(1)[0] = column.name == "t" ? 0.5 : 77.0;
  }
  const AvailableResponse available = readAvailable(table, {}, makeTwoOutputs(), 0.0);
  EXPECT_EQ(expectRight(available, 1e-12), 0);
  ASSERT_EQ(available.remarks.size(), 2u);
  EXPECT_EQ(available.remarks[0], "rows are not in the order of their times: sorted");
  EXPECT_EQ(available.remarks[1], "1 rows with the time of another: the first is taken");
}

TEST(AvailableResponse, RefusesAnOutputThatIsAbsentOrDead) {
  Table absent = record(0.1), dead = record(0.1);
  absent.columns[1].values.setConstant(kNone);
  dead.columns[2].values.setConstant(3.0);
  EXPECT_THROW(readAvailable(absent, {}, makeTwoOutputs(), 0.0), MeasurementError);
  EXPECT_THROW(readAvailable(dead, {}, makeTwoOutputs(), 0.0), MeasurementError);
}

TEST(MissingCells, AreReadAsNaNOnRequest) {
  const std::string text = "t,a\n0,1\n0.1,\n0.2,NaN\n0.3,n/a\n0.4,2\n";
  std::istringstream lenient(text), strict(text), wrong("t,a\n0,1\n0.1,off\n");
  const Table table = readCsv(lenient, "m.csv", {"t", "a"}, MissingCells::kKeep);
  EXPECT_EQ(table.columns[1].values.array().isNaN().count(), 3);
  EXPECT_EQ(table.columns[1].values[4], 2.0);
  EXPECT_THROW(readCsv(strict, "m.csv", {"t", "a"}), MeasurementError);
  EXPECT_THROW(readCsv(wrong, "m.csv", {"t", "a"}, MissingCells::kKeep), MeasurementError);
}

/// One angle in rad at .1, .2, ... 2 s, which the table shows between -pi and pi, and the truth.
const ResponseLayout kAngleLayout{{"q"}, {"rad"}, VectorXd::LinSpaced(20, 0.1, 2.0)};

double calcAngle(double t) {
  return 8.0 * t + 0.3 * std::sin(5.0 * t);
}

Table recordAngle() {
  const VectorXd times = VectorXd::LinSpaced(45, 0.0, 2.2);
  return {"m.csv",
          {{"t", {}, times}, {"q", {}, times.unaryExpr([](double t) {
                                return std::remainder(calcAngle(t), 2.0 * std::acos(-1.0));
                              })}},
          {}};
}

TEST(AvailableResponse, AnglesThatWrapAreContinued) {
  MeasurementSpec spec;
  spec.unwrap = {{"q", {}}};
  Table table = recordAngle();
  table.columns[1].values[11] = kNone;
  const AvailableResponse available = readAvailable(table, spec, kAngleLayout, 0.0);
  for (Index i = 0; i < 20; ++i) {
    if (std::isfinite(available.response[i])) {
      EXPECT_NEAR(available.response[i], calcAngle(kAngleLayout.times[i]), 1e-2) << i;  // of a cubic
    }
  }
  EXPECT_TRUE(describeJumps(table, spec, kAngleLayout).empty());
}

TEST(AvailableResponse, JumpsByAWholeTurnAreNamed) {
  const std::vector<std::string> jumps = describeJumps(recordAngle(), {}, kAngleLayout);
  ASSERT_EQ(jumps.size(), 1u);
  EXPECT_NE(jumps[0].find("measurement.unwrap: [q]"), std::string::npos) << jumps[0];
  Table spiked = record(0.05);
  spiked.columns[1].values[7] += 2.0 * std::acos(-1.0);
  EXPECT_TRUE(describeJumps(spiked, {}, {{"a"}, {"rad"}, kAngleLayout.times}).empty());  // it jumps back
  EXPECT_TRUE(describeJumps(record(0.05), {}, makeTwoOutputs()).empty());
}

TEST(AvailableResponse, ACounterTurnsWithinItsRange) {
  MeasurementSpec spec;
  spec.unwrap = {{"n", {}}};
  spec.ranges = {{{"n", {}}, {0.0, 4096.0, {}}}};
  const VectorXd times = VectorXd::LinSpaced(45, 0.0, 2.2);
  const Table table{
      "m.csv",
      {{"t", {}, times},
       {"n", {}, times.unaryExpr([](double t) { return std::fmod(4000.0 + 3000.0 * t, 4096.0); })}},
      {}};
  const AvailableResponse available = readAvailable(table, spec, {{"n"}, {""}, kAngleLayout.times}, 0.0);
  for (Index i = 0; i < 20; ++i) {
    EXPECT_NEAR(available.response[i], 4000.0 + 3000.0 * kAngleLayout.times[i], 1e-6);
  }
}

TEST(AvailableResponse, SamplesAtALimitAreClipped) {
  MeasurementSpec spec;
  spec.ranges = {{{"a", {}}, {-0.8, 0.8, {}}}};
  Table table = record(0.05);
  table.columns[1].values = table.columns[1].values.cwiseMin(0.8).cwiseMax(-0.8);
  const AvailableResponse available = readAvailable(table, spec, makeTwoOutputs(), 0.0);
  Index clipped = 0;
  for (Index i = 0; i < 20; ++i) {
    clipped += std::abs(calcA(0.1 + 0.1 * static_cast<double>(i))) >= 0.8;
  }
  ASSERT_EQ(static_cast<Index>(available.clipped.size()), clipped);
  EXPECT_EQ(available.missing, 0);
  for (const ClippedSample& sample : available.clipped) {
    EXPECT_TRUE(std::isnan(available.response[sample.row]));
    EXPECT_EQ(sample.limit, 0.8 * sample.side);
  }
  const Measurement measurement = readMeasurement(table, spec, makeTwoOutputs(), 0.0);
  EXPECT_THROW(requireUnclipped(measurement, spec, makeTwoOutputs()), MeasurementError);
}

/// a as in record(), b faster and with times of its own, in ms, which begin 5 s earlier.
Table recordByTwoClocks() {
  Table table = record(0.1);
  const VectorXd fast = VectorXd::NullaryExpr(450, [](Index i) { return 0.005 * static_cast<double>(i); });
  table.columns[2].values = fast.unaryExpr(&calcB);
  table.columns.push_back({"t_fast", "ms", 1e3 * (fast.array() + 5.0)});
  return table;
}

TEST(AvailableResponse, HasAClockForEachColumn) {
  MeasurementSpec spec;
  spec.columns.push_back({{"b", {}}, {}});
  spec.columns[0].time = ColumnSpec{"t_fast", {}, {}};
  spec.columns[0].delay.text = "5";
  EXPECT_TRUE(hasOwnClocks(spec));
  EXPECT_EQ(listColumns(spec, {"a", "b"}), (std::vector<std::string>{"t", "time", "a", "b", "t_fast"}));
  EXPECT_EQ(expectRight(readAvailable(recordByTwoClocks(), spec, makeTwoOutputs(), 0.0), 1e-9), 0);
  spec.columns[0].time.reset();
  spec.columns[0].sample_rate = 200.0;
  spec.columns[0].delay.text = "0";
  EXPECT_EQ(expectRight(readAvailable(recordByTwoClocks(), spec, makeTwoOutputs(), 0.0), 1e-9), 0);
}

TEST(AvailableResponse, TakesAColumnFromAFileBesideTheMeasurement) {
  const TestFolder folder;
  Table table = recordByTwoClocks();
  writeTable(folder / "fast.csv", {table.columns[3], {"acc", "mm", 1e3 * table.columns[2].values}});
  table.columns.resize(2);
  table.source = (folder / "m.csv").string();
  MeasurementSpec spec;
  spec.columns.push_back({{"b", {}}, ColumnSpec{"acc", {}, {}}, Name{"fast.csv", {}}});
  spec.columns[0].time = ColumnSpec{"t_fast", {}, {}};
  spec.columns[0].delay.text = "5";
  EXPECT_EQ(expectRight(readAvailable(table, spec, makeTwoOutputs(), 0.0), 1e-9), 0);
  spec.columns[0].file->text = "none.csv";
  EXPECT_THROW(readAvailable(table, spec, makeTwoOutputs(), 0.0), MeasurementError);
}

TEST(AvailableResponse, MeetsTimesSince1970WithinTheirRounding) {
  Table table = record(0.05);
  table.columns[0].values.array() += 1795687200.25;
  EXPECT_EQ(expectRight(readAvailable(table, {}, makeTwoOutputs(), 1795687200.25), 1e-5), 0);
}

MeasurementSpec startWhen(const std::string& when, double time = 0.0) {
  MeasurementSpec spec;
  spec.start = {time, Name{when, {"e.yaml", 3, 5, "measurement.start.when"}}};
  return spec;
}

TEST(MeasurementStart, IsTheFirstRowADateOrATrigger) {
  const Table table = record(0.05);
  EXPECT_EQ(findStart(table, {}), 0.0);
  EXPECT_EQ(findStart(table, startWhen("first", 0.25)), 0.25);
  EXPECT_EQ(findStart(table, startWhen("2026-11-26T10:00:00.25Z")), 1795687200.25);
  EXPECT_DOUBLE_EQ(findStart(table, startWhen("a > 0.5")), 0.2);          // sin 3t: at .1745 s
  EXPECT_DOUBLE_EQ(findStart(table, startWhen("b < -0.5", -0.1)), 0.95);  // cos 2t: at 1.0472 s
}

TEST(MeasurementStart, ErrorsSayWhatIsWrong) {
  const auto getError = [](const std::string& when) -> std::string {
    try {
      findStart(record(0.05), startWhen(when));
    } catch (const ExperimentError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(getError("a > 2").find("m.csv: column 'a' is never above 2"), std::string::npos);
  EXPECT_NE(getError("b > 0.5").find("m.csv: column 'b' is from its first row on above 0.5"),
            std::string::npos);
  EXPECT_NE(getError("c > 0.5").find("m.csv: has no column 'c'"), std::string::npos);
  EXPECT_NE(getError("a is large").find("e.yaml:3:5: measurement.start.when: 'a is large' must be 'first'"),
            std::string::npos);
}

TEST(TimeStamps, AreSecondsSince1970) {  // by Python's datetime
  double seconds = 0.0;
  const auto read = [&](const char* text) { return parseTimeStamp(text, seconds) ? seconds : NAN; };
  EXPECT_EQ(read("2026-11-26T10:00:00.25Z"), 1795687200.25);
  EXPECT_EQ(read("2026-11-26 10:00:00,25"), 1795687200.25);
  EXPECT_EQ(read("2000-02-29T23:59:59+05:30"), 951848999.0);
  EXPECT_EQ(read("1969-12-31T00:00Z"), -86400.0);
  EXPECT_EQ(read("1900/03/01 00:00:00"), -2203891200.0);
  for (const char* text :
       {"", "2026", "2026-13-01T00:00", "2026-11-26", "2026-11-26T10:00:00Zx", "1-2-3", "12.5"}) {
    EXPECT_FALSE(parseTimeStamp(text, seconds)) << text;
  }
}

}  // namespace
}  // namespace twinmap
