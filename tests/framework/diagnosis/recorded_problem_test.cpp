#include "framework/diagnosis/problem/recorded_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/features/experiment_features.hpp"
#include "framework/diagnosis/structures.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMass = 2.0, kDamping = 3.0, kSpeed = 1.5;

/// A coasting slider: v = v0 exp(-d t / m).
ExperimentSpec makeCoasting(const std::vector<std::string>& overrides = {}) {
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
                                            "coasting.yaml", overrides));
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

/// The log of the likelihood of a sled of some mass, whose samples have an error in common, over the bounds.
double integrateEvidence(const VectorXd& times, const VectorXd& measured, double mass, double common) {
  constexpr int kSteps = 4000;
  const Index n = times.size();
  const MatrixXd covariance = 1e-4 * MatrixXd::Identity(n, n) + MatrixXd::Constant(n, n, common * common);
  const MatrixXd precision = test::calcInverse(covariance);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double d = 1.0 + 5.0 * (i + 0.5) / kSteps;
    const VectorXd residual = measured - VectorXd(kSpeed * (-d / mass * times.array()).exp());
    sum += std::exp(-0.5 * residual.dot(precision * residual)) / kSteps;
  }
  return std::log(sum) - 0.5 * std::log(test::calcDeterminant(covariance));
}

/// Of two structures, in which the noise that the samples share is not the same.
TEST(RecordedProblem, CountsInEvidenceHowLargeAStructuresOwnNoiseIs) {
  const double masses[] = {2.0, 2.2}, common[] = {0.02, 0.2};
  double found[2] = {}, exact[2] = {};
  for (int s = 0; s < 2; ++s) {
    const ExperimentSpec experiment = makeCoasting({"system.bodies.sled.mass=" + std::to_string(masses[s])});
    const MeasurementReader reader(experiment);
    RecordedFeatures recordings = readRecording(reader, record(0.0, 0.1), {}, VectorXd());
    recordings.features[0].array() += 0.03;
    OwnSetup own{experiment.model.excitation, experiment.features, reader.getLayout(), {}};
    own.stated.common = VectorXd::Constant(own.layout.getRowCount(), common[s]);
    recordings.own = {std::make_shared<const OwnSetup>(own)};
    found[s] = calcStructureFit(experiment, recordings, {}).log_evidence;
    exact[s] = integrateEvidence(own.layout.times, recordings.features[0], masses[s], common[s]);
  }
  EXPECT_NEAR(found[1] - found[0], exact[1] - exact[0], 0.05);
  EXPECT_GT(std::abs(exact[1] - exact[0]), 0.2);
}

}  // namespace
}  // namespace twinmap
