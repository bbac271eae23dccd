#include "framework/data/measurement/trained_excitation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

using Signal = std::function<double(double)>;

/// 10 samples a period at 100 Hz, of the faster tone.
double calcForce(double t) {
  return 3.0 * std::sin(2.0 * M_PI * 3.1 * t) + 2.0 * std::sin(2.0 * M_PI * 10.0 * t + 0.3);
}

/// A map trained on 2 s of calcForce, from column "force [N]" at 100 Hz.
ExperimentSpec makeExperiment() {
  SignalSpec signal;
  signal.name.text = "F";
  signal.unit = "N";
  signal.tables.resize(1);
  signal.tables[0].measured = {{"bench.csv", {}}, {"force", {}}, {}, 100.0, 7.0, {}};
  for (int i = -3; i <= 203; ++i) {
    signal.tables[0].times.push_back(0.01 * i);
    signal.tables[0].values.push_back(calcForce(0.01 * i));
  }
  ExperimentSpec experiment;
  experiment.model.excitation.push_back(signal);
  experiment.model.simulation.duration = 2.0;
  return experiment;
}

/// A file in which the model's time 0 is at `start`, from a second before it on for 4 s.
Table measure(const Signal& force, double step = 0.01, double start = 4.0, const std::string& name = "force",
              const std::optional<std::string>& unit = {}) {
  const auto rows = static_cast<Eigen::Index>(std::lround(4.0 / step));
  const Eigen::VectorXd times = Eigen::VectorXd::NullaryExpr(
      rows, [&](Eigen::Index i) { return static_cast<double>(i) * step + start - 1.0; });
  const Eigen::VectorXd values = times.unaryExpr([&](double t) { return force(t - start); });
  return {"m.csv", {{"t", {}, times}, {name, unit, values}}, {}};
}

std::string getExcitationError(const Table& table, double start = 4.0,
                               const ExperimentSpec& experiment = makeExperiment()) {
  try {
    requireTrainedExcitation(experiment, table, start);
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "";
}

// Up to 3 % of the amplitude, another at each time.
double calcNoise(double t) {
  return 0.15 * std::sin(1e5 * t * t);
}

TEST(TrainedExcitation, IsRecognisedAtAnyRateAndStartUpToNoise) {
  EXPECT_EQ(getExcitationError(measure(calcForce)), "");
  EXPECT_EQ(getExcitationError(measure(calcForce, 0.01, 400.0), 400.0), "");
  EXPECT_EQ(getExcitationError(measure([](double t) { return calcForce(t) + calcNoise(t); })), "");
  EXPECT_EQ(getExcitationError(measure([](double t) { return 1.01 * calcForce(t); })), "");
  for (const double step : {0.0013, 0.0097, 0.0125}) {
    EXPECT_EQ(getExcitationError(measure(calcForce, step)), "") << step;
  }
}

// The jump lies between two samples: which side one on it belongs to would be a matter of rounding.
TEST(TrainedExcitation, TheBeginningOfAPeriodicOneMayDiffer) {
  EXPECT_EQ(getExcitationError(measure([](double t) { return t < 0.015 ? 0.0 : calcForce(t); })), "");
}

TEST(TrainedExcitation, AnotherOneIsRefused) {
  const Signal reversed = [](double t) { return calcForce(2.0 - t); };
  const Signal stronger = [](double t) { return 1.03 * calcForce(t); };
  const Signal late = [](double t) { return calcForce(t - 0.01); };
  const Signal none = [](double) { return 0.0; };
  for (const Signal& other : {reversed, stronger, late, none}) {
    for (const double step : {0.01, 0.0033, 0.0125}) {
      EXPECT_NE(getExcitationError(measure(other, step)), "");
    }
  }
  EXPECT_NE(getExcitationError(measure(calcForce), 4.3), "");  // another window of the same file
}

TEST(TrainedExcitation, TheErrorSaysWhichHowMuchWhereAndWhatToDo) {
  const auto spiked = [](double t) { return std::abs(t - 0.5) < 0.004 ? 50.0 : calcForce(t); };
  const std::string error = getExcitationError(measure(spiked));
  for (const char* part : {"m.csv: column 'force' is not the excitation 'F'",
                           "at 4.5 s it is 50 N instead of", "at most 10 %", "--start", "train a map"}) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
}

TEST(TrainedExcitation, ColumnsAreFoundByTheirOwnNameOrTheSignals) {
  const auto negative = [](double t) { return -calcForce(t); };
  const auto kilo = [](double t) { return 1e-3 * calcForce(t); };
  EXPECT_EQ(getExcitationError(measure(kilo, 0.01, 4.0, "F", "kN")), "");
  EXPECT_NE(getExcitationError(measure(negative, 0.01, 4.0, "F")), "");
  EXPECT_EQ(getExcitationError(measure(negative, 0.01, 4.0, "G")), "");
  // A part of a signal is not known by the signal's name.
  ExperimentSpec sum = makeExperiment();
  sum.model.excitation[0].sines.resize(1);
  EXPECT_EQ(getExcitationError(measure(negative, 0.01, 4.0, "F"), 4.0, sum), "");
  EXPECT_NE(getExcitationError(measure(negative), 4.0, sum), "");
  EXPECT_EQ(listExcitationColumns(sum), (std::vector<std::string>{"force", "F"}));
}

TEST(TrainedExcitation, OnlyWhatBothCoverIsCompared) {
  const Table table = measure(calcForce);
  Table late = table;
  for (Column& column : late.columns) {
    column.values = column.values.tail(250).eval();  // from 0.5 s on
  }
  EXPECT_EQ(getExcitationError(late), "");
  EXPECT_EQ(getExcitationError(table, 1e4), "");
  EXPECT_EQ(getExcitationError(
                {"m.csv", {{"t", {}, Eigen::VectorXd::Ones(1)}, {"F", {}, Eigen::VectorXd::Ones(1)}}, {}}),
            "");
}

TEST(TrainedExcitation, WhatLiesInAGapIsNotCompared) {
  Table gap = measure(calcForce);
  for (Column& column : gap.columns) {
    Eigen::VectorXd left(column.values.size() - 15);  // a period and a half of the faster tone
    left << column.values.head(150), column.values.tail(column.values.size() - 165);
    column.values = left;
  }
  EXPECT_EQ(getExcitationError(gap), "");
}

TEST(TrainedExcitation, InAFileOfItsOwnIsComparedWhereTheStartHasMoved) {
  const TestFolder folder;
  ExperimentSpec experiment = makeExperiment();
  const std::string bench = (folder / "bench.csv").string();
  experiment.model.excitation[0].tables[0].measured->file.text = bench;
  const auto rows = static_cast<Eigen::Index>(2000);
  writeTable(bench, {{"force", {}, Eigen::VectorXd::NullaryExpr(rows, [](Eigen::Index i) {
                        return calcForce(0.01 * static_cast<double>(i) - 7.0);
                      })}});
  const Table response{"y.csv", {}, {}};
  EXPECT_EQ(getExcitationError(response, 0.0, experiment), "");
  EXPECT_EQ(getExcitationError(response, 10.0, experiment), "");  // whole periods later
  EXPECT_EQ(
      getExcitationError(response, 0.05, experiment).find(bench + ": column 'force' is not the excitation"),
      0U);
}

}  // namespace
}  // namespace twinmap
