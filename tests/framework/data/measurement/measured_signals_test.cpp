#include "framework/data/measurement/measured_signals.hpp"

#include <gtest/gtest.h>

#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measurement_start.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

class MeasuredSignals : public testing::Test {
 protected:
  MeasuredSignals() {
    std::ofstream file(folder_ / "a.csv");
    file << "t,F [kN],y\n";
    for (int i = 0; i < 100; ++i) {
      file << 0.1 * i << "," << i << ",0\n";
    }
    file.close();
    SignalSpec signal;
    signal.name.text = "F";
    signal.unit = "N";
    signal.tables.resize(1);
    signal.tables[0].measured = {
        {(folder_ / "a.csv").string(), {"e.yaml", 7, 3, "excitation.F"}}, {"F", {}}, {}, {}, 2.0, {}};
    signal.tables[0].measured->time = Name{"t", {}};
    experiment_.model.excitation.push_back(signal);
    experiment_.model.simulation.duration = 1.0;
  }

  TableSpec& updTable() { return experiment_.model.excitation[0].tables[0]; }

  std::string getError() {
    try {
      loadMeasuredSignals(experiment_);
    } catch (const MeasurementError& error) {
      return error.what();
    }
    return "no error";
  }

  TestFolder folder_;
  ExperimentSpec experiment_;
};

TEST_F(MeasuredSignals, AreFilledWithAFewSamplesBeside) {
  loadMeasuredSignals(experiment_);
  const TableSpec& table = updTable();
  ASSERT_EQ(table.times.size(), table.values.size());
  EXPECT_LT(table.times.front(), -0.25);
  EXPECT_GT(table.times.back(), 1.25);
  EXPECT_LT(table.times.size(), 25U);
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    EXPECT_NEAR(table.values[i], 1e4 * (table.times[i] + 2.0), 1e-9);
  }
}

TEST_F(MeasuredSignals, OfAFileOfTheirOwnFollowTheStart) {
  loadMeasuredSignals(experiment_);
  const Table response{"y.csv", {}, {}};
  EXPECT_FALSE(followMeasuredSignals(experiment_, response, 0.0, 0.0));
  for (const double shift : {3.0, -1.5}) {
    ExperimentSpec followed = experiment_;
    ASSERT_TRUE(followMeasuredSignals(followed, response, shift, 0.0));
    const TableSpec& table = followed.model.excitation[0].tables[0];
    for (std::size_t i = 0; i < table.times.size(); ++i) {
      EXPECT_NEAR(table.values[i], 1e4 * (table.times[i] + 2.0 + shift), 1e-9);
    }
  }
}

TEST_F(MeasuredSignals, OfAFileOfTheirOwnAreReplacedByItsPartOfAnotherStart) {
  experiment_.measurement.start.time = 0.5;  // of the recording, whose clock is 1.5 s behind that of the file
  replaceMeasuredSignals(experiment_, Table{"y.csv", {}, {}}, 3.0);
  for (std::size_t i = 0; i < updTable().times.size(); ++i) {
    EXPECT_NEAR(updTable().values[i], 1e4 * (updTable().times[i] + 4.5), 1e-9);
  }
}

TEST_F(MeasuredSignals, OfAnotherRecordingShareItsTime) {
  loadMeasuredSignals(experiment_);
  Table other = readTable(folder_ / "a.csv", listSignalColumns(experiment_));
  other.source = "b.csv";
  experiment_.measurement.start.time = 0.25;
  ASSERT_TRUE(followMeasuredSignals(experiment_, other, 4.0, 0.0));
  EXPECT_NEAR(updTable().values[4], 1e4 * (updTable().times[4] + 4.0), 1e-9);
}

TEST_F(MeasuredSignals, OfARecordingBeginWithItsTrigger) {
  loadMeasuredSignals(experiment_);
  experiment_.measurement.start.when = Name{"F > 35.5", {}};
  experiment_.measurement.time = ColumnSpec{"t", {}, {}};
  const Table table = readTable(folder_ / "a.csv");
  const double start = findStart(table, experiment_.measurement);
  ASSERT_TRUE(followMeasuredSignals(experiment_, table, start, 0.0));
  for (std::size_t i = 0; i < updTable().times.size(); ++i) {
    EXPECT_NEAR(updTable().values[i], 1e4 * (updTable().times[i] + 3.6), 1e-9);
  }
}

TEST_F(MeasuredSignals, OfAFileThatDoesNotCoverTheStartAreRefusedByName) {
  loadMeasuredSignals(experiment_);
  try {
    followMeasuredSignals(experiment_, Table{"y.csv", {}, {}}, 9.0, 0.0);
    FAIL();
  } catch (const MeasurementError& error) {
    EXPECT_NE(std::string(error.what()).find("a.csv: covers"), std::string::npos) << error.what();
  }
}

TEST_F(MeasuredSignals, AreReadOnce) {
  updTable().times = {0.0, 1.0};
  updTable().values = {3.0, 4.0};
  updTable().measured->file.text = "nothing.csv";
  EXPECT_EQ(getError(), "no error");
  EXPECT_EQ(updTable().values[0], 3.0);
}

TEST_F(MeasuredSignals, AreReplacedByAnotherWindow) {
  loadMeasuredSignals(experiment_);
  ASSERT_FALSE(listSignalColumns(experiment_).empty());
  experiment_.measurement.start.time = 2.0;
  replaceMeasuredSignals(experiment_, readTable(folder_ / "a.csv", listSignalColumns(experiment_)), 5.0);
  EXPECT_NEAR(updTable().values[4], 1e4 * (updTable().times[4] + 5.0), 1e-9);
}

TEST_F(MeasuredSignals, FollowAWindowAndHoldTheirEnds) {
  loadMeasuredSignals(experiment_);
  const Table table = readTable(folder_ / "a.csv", listSignalColumns(experiment_));
  EXPECT_FALSE(followMeasuredSignals(experiment_, table, 0.0, 0.0));
  EXPECT_TRUE(followMeasuredSignals(experiment_, table, -2.0, 0.5));  // the file begins where the window does
  EXPECT_NEAR(updTable().times.front(), -0.5, 1e-9);
  EXPECT_EQ(updTable().values.front(), 0.0);
  EXPECT_NEAR(updTable().values.back(), 1e4 * updTable().times.back(), 1e-9);
  EXPECT_THROW(followMeasuredSignals(experiment_, table, 7.5, 0.0), MeasurementError);
}

TEST_F(MeasuredSignals, AnExcerptEndsBeforeTheSimulation) {
  updTable().measured->duration = 0.5;
  loadMeasuredSignals(experiment_);
  EXPECT_NEAR(updTable().times.back(), 0.5, 1e-9);
}

TEST_F(MeasuredSignals, CoverEveryDelayWithinTheBounds) {
  experiment_.model.nuisance = {{{"late", {}}, {-1.5, 2.0, {}}, "s", "", RelativeTo::kAutomatic, {}}};
  updTable().measured->delay.text = "0.5 + late";
  loadMeasuredSignals(experiment_);
  EXPECT_LE(updTable().times.front(), -1.0);
  EXPECT_GE(updTable().times.back(), 3.5);
  updTable().times.clear();
  updTable().measured->start = 0.5;
  EXPECT_EQ(getError(), "e.yaml:7:3: excitation.F: " + (folder_ / "a.csv").string() +
                            ": covers 0 s to 4.4 s, but -0.5 s to 4 s is needed");
}

TEST_F(MeasuredSignals, ErrorsNameKeyFileAndRule) {
  const std::string start = "e.yaml:7:3: excitation.F: " + (folder_ / "a.csv").string() + ": ";
  updTable().measured->start = 9.5;
  EXPECT_EQ(getError(), start + "covers 9.1 s to 9.9 s, but 9.5 s to 10.5 s is needed");
  updTable().measured->start = 2.0;
  updTable().measured->column.text = "Fo";
  EXPECT_EQ(getError(), start + "has no column 'Fo'; did you mean 'F'? (it has: t, F, y)");
  updTable().measured->column.text = "y [mm]";
  EXPECT_NE(getError().find("'mm' does not convert to N"), std::string::npos);
  updTable().measured->file.text = "nothing.csv";
  EXPECT_EQ(getError(), "e.yaml:7:3: excitation.F: nothing.csv: does not exist");
}

}  // namespace
}  // namespace twinmap
