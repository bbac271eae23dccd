#include "framework/data/measurement/measurement.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd makeTimes(Index count, double step, double from = 0.0) {
  return VectorXd::NullaryExpr(count, [&](Index i) { return from + step * static_cast<double>(i); });
}

ResponseLayout makeLayout(const VectorXd& times) {
  return {{"y", "theta"}, {"m", "rad"}, times, 0};
}

VectorXd wave(const VectorXd& times) {
  return (3.0 * times.array()).sin();
}

/// y = sin 3t, theta = t^3 - t, which cubics reproduce.
Table makeCubicTable(const VectorXd& times) {
  return {"a.csv",
          {{"t", {}, times}, {"y", {}, wave(times)}, {"theta", {}, times.array().cube() - times.array()}},
          {}};
}

VectorXd resampleTable(const Table& table, const ResponseLayout& layout, const MeasurementSpec& spec = {},
                       std::optional<double> interval = {}) {
  return resample(readMeasurement(table, spec, layout, spec.start.time), layout, interval);
}

std::string getResamplingError(const Table& table, const ResponseLayout& layout,
                               const MeasurementSpec& spec = {}, std::optional<double> interval = {}) {
  try {
    resampleTable(table, layout, spec, interval);
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "no error";
}

Table without(Table table, Index row) {
  for (Column& column : table.columns) {
    const Index rest = column.values.size() - row - 1;
    column.values.segment(row, rest) = column.values.tail(rest).eval();
    column.values.conservativeResize(column.values.size() - 1);
  }
  return table;
}

/// Of a column that is to be in this unit.
std::string describeUnread(const std::string& header, const std::string& unit,
                           const ColumnSpec& wanted = {}) {
  const ColumnSpec column = parseColumn(header);
  const Table table{"a.csv", {{column.name, column.unit, VectorXd::Zero(2)}}, {}};
  return describeUnreadUnit(table, wanted.name.empty() ? ColumnSpec{column.name, {}, {}} : wanted, unit);
}

TEST(UnreadUnits, AreNamedWithWhatIsAssumed) {
  const std::string said = describeUnread("Zeit(ms)", "s");
  EXPECT_NE(said.find("'ms' in the name of column 'Zeit(ms)' is not read as its unit: s is assumed"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("'Zeit(ms) [ms]'"), std::string::npos) << said;
  EXPECT_NE(describeUnread("t_ms", "s"), "");
  EXPECT_NE(describeUnread("Weg, mm", "m").find("m is assumed"), std::string::npos);
  EXPECT_NE(describeUnread("Kraft/kN", "N"), "");
  EXPECT_NE(describeUnread("Zeit (foo)", "s").find("'foo'"), std::string::npos);
}

TEST(UnreadUnits, AreNoneWhereTheUnitIsReadOrTheSameOrANameAlone) {
  for (const char* header : {"Zeit [ms]", "Zeit (ms)", "t_s", "time(s)", "t", "t_rel", "t, N"}) {
    EXPECT_EQ(describeUnread(header, "s"), "") << header;
  }
  for (const char* header : {"x(t)", "x (left)", "x_in", "x_mm", "x, m", "x/2"}) {
    EXPECT_EQ(describeUnread(header, "m"), "") << header;
  }
  EXPECT_EQ(describeUnread("t_ms", "s", parseColumn("t_ms [ms]")), "");
}

TEST(Measurement, NeedsNoColumnOfAnOutputThatNoFeatureUses) {
  const VectorXd times = makeTimes(60, 0.01);
  Table table = makeCubicTable(times);
  const ResponseLayout layout = makeLayout(makeTimes(5, 0.1));
  const VectorXd whole = resampleTable(table, layout);
  table.columns.erase(table.columns.begin() + 1);
  EXPECT_THROW(readMeasurement(table, {}, layout, 0.0), MeasurementError);
  SamplesFeatureSpec samples;
  samples.outputs = {{"theta", {}}};
  const VectorXd alone = resample(readMeasurement(table, {}, layout, 0.0, {samples}), layout);
  EXPECT_EQ(alone.tail(5), whole.tail(5));
  EXPECT_TRUE(alone.head(5).array().isNaN().all());
}

TEST(Measurement, TimesSince1970KeepTheirMilliseconds) {
  EXPECT_EQ(describeTime(1.545), "1.545 s");
  EXPECT_EQ(describeTime(1700000000.379473), "1700000000.379 s");
}

TEST(Measurement, IsExactWhereTimesAgree) {
  const VectorXd times = makeTimes(500, 0.01);
  const ResponseLayout layout = makeLayout(makeTimes(20, 0.05, 0.05));
  const Table table = makeCubicTable(times);
  const VectorXd response = resampleTable(table, layout);
  for (Index i = 0; i < layout.times.size(); ++i) {
    EXPECT_EQ(response[layout.getRow(0, i)], table.columns[1].values[5 * (i + 1)]);
    EXPECT_EQ(response[layout.getRow(1, i)], table.columns[2].values[5 * (i + 1)]);
  }
}

TEST(Measurement, InterpolatesCubicallyBetweenSamples) {
  const VectorXd times = makeTimes(300, 0.013);
  const ResponseLayout layout = makeLayout(makeTimes(60, 0.05, 0.005));
  const VectorXd response = resampleTable(makeCubicTable(times), layout);
  const VectorXd exact = wave(layout.times);
  for (Index i = 0; i < layout.times.size(); ++i) {
    const double t = layout.times[i];
    EXPECT_NEAR(response[layout.getRow(1, i)], t * t * t - t, 1e-13);
    // |f''''| = 81; the product of the distances is at most 24 h^4 / 24 at the ends, where the cubic is
    // one-sided
    EXPECT_NEAR(response[layout.getRow(0, i)], exact[i], 81.0 * std::pow(0.013, 4) / 24.0);
  }
}

TEST(Measurement, ConvertsUnitsTakesColumnsAndShiftsTime) {
  std::istringstream csv("time [ms],enc1 [mm],enc2\n100,1000,90\n150,2000,180\n200,3000,-90\n");
  MeasurementSpec spec;
  spec.start.time = 0.1;
  spec.columns = {{{"y", {}}, ColumnSpec{"enc1", {}, {}}}, {{"theta", {}}, ColumnSpec{"enc2", "deg", {}}}};
  EXPECT_EQ(listColumns(spec, {"y", "theta"}), (std::vector<std::string>{"t", "time", "enc1", "enc2"}));
  const ResponseLayout layout = makeLayout(makeTimes(3, 0.05));
  const VectorXd response =
      resampleTable(readCsv(csv, "a.csv", listColumns(spec, layout.output_names)), layout, spec);
  const double pi = 3.141592653589793;
  const VectorXd expected = (VectorXd(6) << 1.0, 2.0, 3.0, pi / 2, pi, -pi / 2).finished();
  EXPECT_TRUE(response.isApprox(expected, 1e-15)) << response;
}

TEST(Measurement, HasTimesByItsSampleRate) {
  Table table = makeCubicTable(makeTimes(200, 0.01));
  table.columns.erase(table.columns.begin());
  MeasurementSpec spec;
  spec.sample_rate = 100.0;
  spec.start.time = 0.5;
  const ResponseLayout layout = makeLayout(makeTimes(10, 0.1));
  EXPECT_NEAR(resampleTable(table, layout, spec)[3], std::sin(3.0 * 0.8), 1e-15);
  EXPECT_EQ(getResamplingError(table, layout),
            "a.csv: has no column named t or time; give measurement.time or measurement.sample_rate");
}

TEST(Measurement, ErrorsOfUnitsAndColumns) {
  const Table table = makeCubicTable(makeTimes(200, 0.01));
  const ResponseLayout layout = makeLayout(makeTimes(10, 0.1));
  MeasurementSpec spec;
  spec.columns = {{{"y", {}}, ColumnSpec{"z", {}, {}}}};
  EXPECT_NE(getResamplingError(table, layout, spec).find("a.csv: has no column 'z'"), std::string::npos);
  Table volts = table;
  volts.columns[1].unit = "V";
  EXPECT_EQ(getResamplingError(volts, layout), "a.csv: y: 'V' does not convert to m");
  Table shorter = table;
  shorter.columns[2].values.conservativeResize(100);
  EXPECT_EQ(getResamplingError(shorter, layout),
            "a.csv: column 'theta' has 100 numbers, but there are 200 times");
  Table still = table;
  still.columns[0].values[7] = still.columns[0].values[6];
  EXPECT_EQ(getResamplingError(still, layout),
            "a.csv: column 't' has 0.06 in row 8, after 0.06; times must increase");
}

TEST(Measurement, ErrorsOfTimes) {
  const ResponseLayout layout = makeLayout(makeTimes(20, 0.05, 0.05));
  EXPECT_EQ(getResamplingError(makeCubicTable(makeTimes(50, 0.01)), layout),
            "a.csv: ends at 0.49 s, but is needed until 1 s");
  EXPECT_EQ(getResamplingError(makeCubicTable(makeTimes(200, 0.01, 0.07)), layout),
            "a.csv: begins at 0.07 s, but is needed from 0.05 s on");
  EXPECT_EQ(getResamplingError(makeCubicTable(makeTimes(100, 0.06)), layout),
            "a.csv: has a sample each 0.06 s (median); at least one each 0.05 s is needed");
  EXPECT_EQ(getResamplingError(makeCubicTable(makeTimes(1, 0.06)), layout),
            "a.csv: has 1 samples; must have at least 2");
  EXPECT_EQ(getResamplingError(without(makeCubicTable(makeTimes(200, 0.01)), 50), layout),
            "a.csv: has a gap of 0.02 s after t = 0.49 s, where samples are needed; the median step is "
            "0.01 s");
  EXPECT_EQ(getResamplingError(without(makeCubicTable(makeTimes(200, 0.01)), 150), layout),
            "no error");  // where none is needed
  EXPECT_EQ(getResamplingError(makeCubicTable(makeTimes(200, 0.0503)), layout), "no error");  // below 1 %
}

TEST(Measurement, TheIntervalOfFeaturesCountsWhereTheirTimesInterleave) {
  VectorXd times(40);
  for (Index i = 0; i < 20; ++i) {
    times.segment(2 * i, 2) << 0.05 * (i + 1), 0.05 * (i + 1) + 0.001;
  }
  const Table table = makeCubicTable(makeTimes(200, 0.01));
  EXPECT_NE(getResamplingError(table, makeLayout(times)).find("at least one each 0.001 s"),
            std::string::npos);
  EXPECT_EQ(getResamplingError(table, makeLayout(times), {}, 0.05), "no error");
}

TEST(Measurement, ASimulatedResponseWithHolesIsAMeasurement) {
  const VectorXd times = (VectorXd(6) << 0.1, 0.2, 0.3, 2.0, 2.05, 3.0).finished();
  EXPECT_EQ(getResamplingError(makeCubicTable(times), makeLayout(times)), "no error");
}

TEST(Measurement, ErrorsOfADeadSensorAndOfModes) {
  Table table = makeCubicTable(makeTimes(200, 0.01));
  table.columns[2].values.head(150).setConstant(0.25);
  const ResponseLayout layout = makeLayout(makeTimes(20, 0.05, 0.05));
  EXPECT_EQ(
      getResamplingError(table, layout),
      "a.csv: column 'theta' is 0.25 (constant signal) from 0.05 s to 1 s; check the sensor and its cable");
  ResponseLayout modes = layout;
  modes.modes = 2;
  EXPECT_EQ(getResamplingError(table, modes), "a.csv: holds no modes, of which features are made");
}

}  // namespace
}  // namespace twinmap
