#include <gtest/gtest.h>

#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A spring with a damper, released and, for longer and at other times, struck with a speed that is unknown.
const char* const kTwoTrials = R"(
name: oscillator
parameters: {k: {bounds: [5, 15], unit: N/m}, d: {bounds: [0.1, 0.5], unit: N s/m}}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 20}}]
noise: {stddev: {x: 1e-3}}
trials:
  release: {initial: {coordinates: {x: 0.1}}}
  strike:
    initial: {speeds: {x: v}}
    nuisance: {v: {bounds: [0.5, 1], unit: m/s}}
    outputs: {w: {speed: x}, x: {coordinate: x}}
    simulation: {duration: 3}
    features: [{samples: {outputs: [w, x], start: 0.15, interval: 0.15, count: 20}}]
    noise: {stddev: {w: 1e-2, x: 1e-3}}
)";

struct Simulated {
  ResponseLayout layout;
  MatrixXd responses, derivatives;
};

ExperimentSpec readTwo(const std::vector<std::string>& overrides = {}) {
  return readExperiment(parseExperimentTree(kTwoTrials, "trials.yaml", overrides));
}

std::unique_ptr<Simulator> makeOf(const ExperimentSpec& experiment) {
  const ResponseLayout layout = makeLayout(experiment);
  return makeSimulator(experiment.model, layout.times, layout.modes);
}

Simulated simulateWithSlopes(Simulator& simulator, const MatrixXd& points) {
  Simulated simulated{simulator.getLayout(), {}, {}};
  simulated.responses.resize(simulated.layout.getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(static_cast<std::size_t>(points.cols()));
  simulator.simulateWithDerivatives(points, simulated.responses, simulated.derivatives, statuses.data());
  for (const SampleStatus& status : statuses) {
    EXPECT_TRUE(status.ok) << status.reason;
  }
  return simulated;
}

MatrixXd makeThreePoints() {
  MatrixXd points(3, 2);  // k, d, strike.v
  points << 7.0, 12.0, 0.2, 0.4, 0.6, 0.9;
  return points;
}

TEST(TrialsSimulator, GivesEachTrialsFeaturesAndDerivatives) {
  const ExperimentSpec both = readTwo(), release = readTwo({"trial=release"}),
                       strike = readTwo({"trial=strike"});
  const MatrixXd points = makeThreePoints();
  const Simulated all = simulateWithSlopes(*makeOf(both), points);
  const Simulated first = simulateWithSlopes(*makeOf(release), points.topRows(2)),
                  second = simulateWithSlopes(*makeOf(strike), points);
  EXPECT_EQ(all.layout.output_names, (std::vector<std::string>{"release.x", "strike.w", "strike.x"}));
  EXPECT_EQ(all.layout.output_units, (std::vector<std::string>{"m", "m/s", "m"}));

  const FeatureExtractor extractor = makeExtractor(both, all.layout),
                         of_first = makeExtractor(release, first.layout),
                         of_second = makeExtractor(strike, second.layout);
  const auto release_count = static_cast<Index>(of_first.getInfos().size());
  for (Index i = 0; i < points.cols(); ++i) {
    const VectorXd features = extractor.extract(all.responses.col(i));
    VectorXd expected(features.size());
    expected << of_first.extract(first.responses.col(i)), of_second.extract(second.responses.col(i));
    // other sample times lie between, and steps that end at none of them
    EXPECT_LT((features - expected).cwiseAbs().maxCoeff(), 1e-12);
    for (Index k = 0; k < 3; ++k) {
      const VectorXd slope = extractor.extract(all.derivatives.col(3 * i + k));
      const VectorXd of_strike = of_second.extract(second.derivatives.col(3 * i + k));
      EXPECT_LT((slope.tail(of_strike.size()) - of_strike).cwiseAbs().maxCoeff(), 1e-10);
      const VectorXd of_release =
          k < 2 ? of_first.extract(first.derivatives.col(2 * i + k)) : VectorXd::Zero(release_count);
      EXPECT_LT((slope.head(release_count) - of_release).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

TEST(TrialsSimulator, NamesTheTrialThatFails) {
  ExperimentSpec both = readTwo();
  both.model.trials[1].model.simulation.max_steps = 1;
  const std::unique_ptr<Simulator> simulator = makeOf(both);
  MatrixXd responses(simulator->getLayout().getRowCount(), 2);
  std::vector<SampleStatus> statuses(2);
  simulator->simulate(makeThreePoints(), responses, statuses.data());
  EXPECT_FALSE(statuses[1].ok);
  EXPECT_EQ(statuses[1].reason.rfind("trial 'strike': ", 0), 0u) << statuses[1].reason;
  EXPECT_TRUE(responses.hasNaN());
}

Table makeRecordingTable(const std::vector<std::string>& names, double interval, Index rows) {
  Table table;
  table.source = names.back() + ".csv";
  table.columns.push_back(
      {"t", {}, VectorXd::LinSpaced(rows, 0.0, interval * static_cast<double>(rows - 1))});
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.columns.push_back({names[i], {}, (table.columns.front().values.array() + double(i)).cos()});
  }
  return table;
}

TEST(TrialReader, PutsTheFeaturesOfAllTrialsBehindOneAnother) {
  const ExperimentSpec both = readTwo();
  const TrialReader reader(both);
  const Table release = makeRecordingTable({"x"}, 0.1, 21), strike = makeRecordingTable({"x", "w"}, 0.15, 21);
  const RecordedTable first{"release", "release.csv", release}, second{"strike", "strike.csv", strike};
  const std::optional<VectorXd> features = reader.read({second, first});
  ASSERT_TRUE(features);
  ASSERT_EQ(features->size(), 60);
  EXPECT_NEAR((*features)[0], std::cos(0.1), 1e-12);
  EXPECT_NEAR((*features)[20], std::cos(0.15 + 1.0), 1e-12);  // w comes first there
  EXPECT_NEAR((*features)[40], std::cos(0.15), 1e-12);

  EXPECT_FALSE(reader.read({first}));
  EXPECT_FALSE(reader.read({first, first, second}));
  EXPECT_THROW(reader.get("stroke"), ExperimentError);
  EXPECT_THROW(MeasurementReader(both).readFeatures(release, {}), ExperimentError);
}

}  // namespace
}  // namespace twinmap
