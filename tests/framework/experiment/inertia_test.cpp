#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

std::string describeBlock(const std::string& inertia) {
  return R"(
name: block
parameters:
  m: {bounds: [1, 3], unit: kg}
  lx: {bounds: [0.1, 0.5], unit: m}
  s: {bounds: [-0.2, 0.2], unit: m}
system:
  bodies: {block: {mass: m, inertia: )" +
         inertia + R"(, joint: {type: ball, coordinates: [a, b, c]}}}
initial: {speeds: {a: 1}}
outputs: {w: {speed: a}}
simulation: {duration: 1}
features: [{samples: {outputs: [w], start: 0.1, interval: 0.1, count: 5}}]
noise: {stddev: {w: 1e-3}}
)";
}

ExperimentSpec readBlock(const std::string& inertia) {
  return readExperiment(parseExperimentTree(describeBlock(inertia), "block.yaml"));
}

TEST(SpreadOfMass, GivesTheTensorOfItsSecondMoment) {
  const InertiaSpec inertia =
      readBlock("{spread: [lx, 0.3, 0.1], skew: [s, 0.05, -0.02]}").model.system.bodies[0].inertia;
  EXPECT_FALSE(inertia.spread);
  NamedValues<double> values;
  values.define("m", 2.0);
  values.define("lx", 0.4);
  values.define("s", -0.15);
  Eigen::Matrix3d spread;
  spread << 0.4, -0.15, 0.05, 0.0, 0.3, -0.02, 0.0, 0.0, 0.1;
  const Eigen::Matrix3d moment = 2.0 * spread * spread.transpose();
  const Eigen::Matrix3d tensor = moment.trace() * Eigen::Matrix3d::Identity() - moment;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(values.calc(inertia.moments[static_cast<std::size_t>(i)]), tensor(i, i), 1e-15);
  }
  EXPECT_NEAR(values.calc(inertia.products[0]), tensor(0, 1), 1e-15);
  EXPECT_NEAR(values.calc(inertia.products[1]), tensor(0, 2), 1e-15);
  EXPECT_NEAR(values.calc(inertia.products[2]), tensor(1, 2), 1e-15);
}

TEST(SpreadOfMass, StandsAlone) {
  EXPECT_NO_THROW(readBlock("{spread: [lx, lx, lx], skew: [s, s, 0]}"));
  for (const char* inertia :
       {"{spread: [lx, lx, lx], moments: [1, 1, 1]}", "{skew: [s, s, s]}", "{spread: [m, m, m]}"}) {
    EXPECT_THROW(readBlock(inertia), ExperimentError) << inertia;
  }
}

TEST(SpreadOfMass, ReadsBackAsItWasWritten) {
  const std::string text = writeExperiment(readBlock("{spread: [lx, 0.3, 0.1], skew: [s, 0, 0]}"));
  EXPECT_EQ(writeExperiment(readExperiment(parseYaml(text, "again"))), text);
}

}  // namespace
}  // namespace twinmap
