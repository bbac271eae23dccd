#include "framework/diagnosis/problem/recorded_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMass = 2.0, kDamping = 3.0, kSpeed = 1.5;

/// A coasting slider: v = v0 exp(-d t / m).
ExperimentSpec makeCoasting() {
  return readExperiment(parseExperimentTree(R"(
name: coasting
parameters: {d: {bounds: [1, 6], unit: N s/m}}
system:
  bodies: {sled: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  dampers: [{coordinate: x, damping: d}]
initial: {speeds: {x: 1.5}}
outputs: {v: {speed: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [v], start: 0.1, interval: 0.1, count: 19}}]
noise: {stddev: {v: 0.01}}
)",
                                            "coasting.yaml"));
}

/// Samples each `step` s from `first` on, at which the speed is exact.
Table record(double first, double step) {
  const auto rows = static_cast<Index>((2.0 - first) / step);
  Table table{"m.csv", {{"t", {}, VectorXd(rows)}, {"v", {}, VectorXd(rows)}}, {}};
  for (Index i = 0; i < rows; ++i) {
    const double t = first + step * static_cast<double>(i);
    table.columns[0].values[i] = t;
    table.columns[1].values[i] = kSpeed * std::exp(-kDamping * t / kMass);
  }
  return table;
}

TEST(RecordedProblem, HasEachRecordingAtItsOwnTimes) {
  const MeasurementReader reader(makeCoasting());
  RecordedFeatures recordings{reader.getLayout(), {}, VectorXd()};
  append(readRecording(reader, record(0.0, 0.1), {}, VectorXd()), recordings);    // those of the features
  append(readRecording(reader, record(0.07, 0.31), {}, VectorXd()), recordings);  // too sparse between
  EXPECT_EQ(recordings.findOwn(0), nullptr);
  const RecordingsProblem problem(reader.getExperiment(), recordings);
  const std::vector<FeatureInfo> infos = problem.listInfos();
  ASSERT_EQ(infos.size(), 19 + 6);
  EXPECT_NEAR(infos[19].time, 0.07, 1e-12);
  EXPECT_NEAR(infos[24].time, 0.07 + 5 * 0.31, 1e-9);
  const LinearizedRecordings linear = problem.linearize(VectorXd::Constant(1, kDamping));
  EXPECT_LT(linear.residual.cwiseAbs().maxCoeff(), 1e-3);  // of the noise
  for (Index i = 0; i < linear.jacobian.rows(); ++i) {
    const double t = infos[static_cast<std::size_t>(i)].time;
    const double exact = -t / kMass * kSpeed * std::exp(-kDamping * t / kMass) / 0.01;
    EXPECT_NEAR(std::abs(linear.jacobian(i, 0)), std::abs(exact), 1e-3 * std::abs(exact)) << t;
  }
}

TEST(RecordedProblem, KeepsTheTimesOfWhatIsSelected) {
  const MeasurementReader reader(makeCoasting());
  RecordedFeatures recordings{reader.getLayout(), {}, VectorXd()};
  append(readRecording(reader, record(0.0, 0.1), {}, VectorXd()), recordings);
  append(readRecording(reader, record(0.07, 0.31), {}, VectorXd()), recordings);
  const RecordedFeatures second = recordings.leaveOut(0);
  EXPECT_NEAR(second.getLayout(0).times[1], 0.38, 1e-9);
  const SingleRecording single =
      takeRecording(reader.getExperiment(), recordings, VectorXd::Constant(1, kDamping), 1);
  EXPECT_EQ(makeLayout(single.experiment).times, second.getLayout(0).times);
}

}  // namespace
}  // namespace twinmap
