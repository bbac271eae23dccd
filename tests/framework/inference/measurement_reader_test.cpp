#include "framework/inference/measurement_reader.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A sled whose controller reads its speed, and whose features are samples of its position alone.
ExperimentSpec makeControlled(const std::string& more) {
  return readExperiment(parseExperimentTree(R"(
name: controlled
parameters: {d: {bounds: [1, 6], unit: N s/m}}
system:
  bodies: {sled: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  dampers: [{coordinate: x, damping: d}]
  controllers: {hold: {reads: {speed_read: v}, sample_time: 0.05, writes: {push: {value: -3*speed_read, unit: N}}}}
  force_laws: [{coordinate: x, force: push}]
initial: {speeds: {x: 1.5}}
outputs: {x: {coordinate: x}, v: {speed: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 19}}]
noise: {stddev: {x: 0.01, v: 0.01}}
)" + more,
                                            "controlled.yaml"));
}

/// x = t^2, with no column of the speed.
Table record(double late) {
  const VectorXd times = VectorXd::LinSpaced(41, 0.0, 2.0);
  return {"m.csv", {{"t", {}, times.array() + late}, {"x", {}, times.cwiseAbs2()}}, {}};
}

TEST(MeasurementReader, NeedsNoColumnOfASensorThatOnlyAControllerReads) {
  const MeasurementReader reader(makeControlled(""));
  const VectorXd features = reader.readFeatures(record(0.0), {});
  ASSERT_EQ(features.size(), 19);
  EXPECT_NEAR(features[18], 1.9 * 1.9, 1e-12);
}

TEST(MeasurementReader, NeedsNoneBesideAClockOfItsOwnEither) {
  const MeasurementReader reader(makeControlled("measurement: {columns: {x: {column: x, delay: 0.3}}}\n"));
  EXPECT_NEAR(reader.readFeatures(record(0.3), {})[18], 1.9 * 1.9, 1e-12);
}

}  // namespace
}  // namespace twinmap
