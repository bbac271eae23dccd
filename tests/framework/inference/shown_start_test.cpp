#include "framework/inference/shown_start.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr const char* kReleased = R"(
name: released
parameters: {k: {bounds: [1, 9], unit: N/m}}
nuisance:
  x0: {bounds: [-2, 2], unit: m}
  v0: {bounds: [-3, 3], unit: m/s}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
initial: {coordinates: {x: x0}, speeds: {x: v0}}
outputs: {x: {coordinate: x}}
simulation: {duration: 1}
features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 9}}]
noise: {stddev: {x: 1e-3}}
inverse_map: none
)";

VectorXd readShown(const char* changes, const VectorXd& samples) {
  std::vector<std::string> set;
  if (*changes != '\0') {
    set.emplace_back(changes);
  }
  const ExperimentSpec experiment = readExperiment(parseExperimentTree(kReleased, "released.yaml", set));
  std::vector<FeatureInfo> infos;
  for (Index i = 0; i < samples.size(); ++i) {
    FeatureInfo info;
    info.output = 0;
    info.time = 0.1 * static_cast<double>(i + 1);
    infos.push_back(info);
  }
  return readShownStart(experiment.model, infos, samples);
}

/// Of x = 1 + 2 t + 3 t^2, at 0.1, 0.2 ... s.
VectorXd makeParabola() {
  return VectorXd::NullaryExpr(5, [](Index i) {
    const double t = 0.1 * static_cast<double>(i + 1);
    return 1.0 + 2.0 * t + 3.0 * t * t;
  });
}

TEST(ShownStart, IsThatOfAParabola) {
  const VectorXd shown = readShown("", makeParabola());
  ASSERT_EQ(shown.size(), 3);
  EXPECT_TRUE(std::isnan(shown[0]));
  EXPECT_NEAR(shown[1], 1.0, 1e-12);
  EXPECT_NEAR(shown[2], 2.0, 1e-12);
}

TEST(ShownStart, PassesOverMissingSamples) {
  VectorXd samples = makeParabola();
  samples[1] = std::nan("");
  EXPECT_NEAR(readShown("", samples)[1], 1.0, 1e-12);
  samples.tail(3).setConstant(std::nan(""));
  EXPECT_EQ(readShown("", samples).size(), 0);
}

TEST(ShownStart, StaysWithinTheBounds) {
  EXPECT_EQ(readShown("nuisance.v0.bounds=[-3, 1.5]", makeParabola())[2], 1.5);
}

TEST(ShownStart, IsReadThroughASensorThatIsKnown) {
  const VectorXd shown = readShown("outputs.x={coordinate: x, gain: 2, offset: 0.5}", makeParabola());
  ASSERT_EQ(shown.size(), 3);
  EXPECT_NEAR(shown[1], 0.25, 1e-12);
  EXPECT_NEAR(shown[2], 1.0, 1e-12);
  EXPECT_EQ(readShown("outputs.x={coordinate: x, offset: x0}", makeParabola()).size(), 0);
}

TEST(ShownStart, HasTheSpeedThatIsMeasured) {
  const VectorXd shown = readShown("outputs={x: {speed: x}}", makeParabola());
  ASSERT_EQ(shown.size(), 3);
  EXPECT_TRUE(std::isnan(shown[1]));
  EXPECT_NEAR(shown[2], 1.0, 1e-12);
}

}  // namespace
}  // namespace twinmap
