#include "framework/inference/measurement/unknown_excitation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoise = 0.3;
constexpr std::size_t kTimes = 40;

/// A cart on a spring, pushed as a table says of which the noise is known; its times are uneven.
ExperimentSpec makePushed(const std::string& interpolation, const std::string& delay) {
  ExperimentSpec experiment = readExperiment(parseExperimentTree(R"(
name: pushed
parameters: {k: {bounds: [10, 60], unit: N/m}, late: {bounds: [0, 0.2], unit: s}}
system:
  bodies: {cart: {mass: 2, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: 1.5}]
  force_laws: [{coordinate: x, force: F}]
excitation: {F: {unit: N, tables: [{times: [0, 1], values: [0, 1], interpolation: )" +
                                                                     interpolation +
                                                                     R"(}]}}
outputs: {x: {coordinate: x}, v: {speed: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x, v], start: 0.05, interval: 0.05, count: 39}}]
noise: {stddev: {x: 0.01, v: 0.01}}
)",
                                                                 "pushed.yaml"));
  TableSpec& table = experiment.model.excitation[0].tables[0];
  table.times.clear();
  table.values.clear();
  for (std::size_t i = 0; i < kTimes; ++i) {
    const auto n = static_cast<double>(i);
    table.times.push_back(-0.1 + 0.06 * n + 0.01 * std::sin(3.0 * n));
    table.values.push_back(std::sin(0.7 * n));
  }
  table.measured.emplace();
  table.measured->noise = kNoise;
  table.measured->delay.text = delay;
  return experiment;
}

VectorXd simulatePushed(const ExperimentSpec& experiment, const VectorXd& point) {
  const ResponseLayout layout = makeLayout(experiment);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(experiment.model, layout.times)->simulate(point, response, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  return response.col(0);
}

/// The machine is linear: what a sample adds is that of its table with the sample changed by any amount.
void expectColumns(const std::string& interpolation, const std::string& delay) {
  const ExperimentSpec experiment = makePushed(interpolation, delay);
  const Eigen::Vector2d point(30.0, 0.07);
  const MatrixXd responses = calcUnknownResponses(experiment.model, makeLayout(experiment), point);
  ASSERT_EQ(responses.cols(), static_cast<Index>(kTimes));
  const VectorXd usual = simulatePushed(experiment, point);
  for (const std::size_t i : {std::size_t{0}, std::size_t{15}, std::size_t{16}, kTimes - 1}) {
    ExperimentSpec changed = experiment;
    changed.model.excitation[0].tables[0].values[i] += 20.0 * kNoise;
    const VectorXd exact = (simulatePushed(changed, point) - usual) / 20.0;
    EXPECT_LT((responses.col(static_cast<Index>(i)) - exact).norm(),
              1e-5 * responses.colwise().norm().maxCoeff())
        << interpolation << " " << delay << " " << i;
  }
  EXPECT_GT(responses.col(10).norm(), 0.0);
}

TEST(UnknownExcitation, ActsAsEachSampleOfItsTableDoes) {
  for (const char* interpolation : {"linear", "hold", "cubic"}) {
    expectColumns(interpolation, Expression{}.text);
    expectColumns(interpolation, "late");
  }
}

}  // namespace
}  // namespace twinmap
