// Recordings of a free oscillator, by its closed form, whose sensor has another fault in each.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Statuses = std::vector<std::string>;

constexpr double kNoise = 0.01, kStiffness = 50.0, kDamping = 0.8;
constexpr Index kSamples = 200;
constexpr std::size_t kRecordings = 3;

ExperimentSpec makeOscillator() {
  return readExperiment(parseExperimentTree(R"(
name: oscillator
parameters: {k: {bounds: [30, 80], unit: N/m}, d: {bounds: [0, 2], unit: N s/m}}
nuisance: {x0: {bounds: [0.5, 2], unit: m}}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
initial: {coordinates: {x: x0}}
outputs: {x: {coordinate: x}}
simulation: {duration: 4}
features: [{samples: {outputs: [x], start: 0, interval: 0.02, count: 200}}]
noise: {stddev: {x: 0.01}}
)",
                                            "oscillator.yaml", {}));
}

/// The free response from x0 at rest, with noise (n) of that size.
Table record(double x0, const VectorXd& noise) {
  Table table{"m.csv", {{"t", {}, VectorXd(kSamples)}, {"x", {}, VectorXd(kSamples)}}, {}};
  const double rate = 0.5 * kDamping, omega = std::sqrt(kStiffness - rate * rate);
  for (Index i = 0; i < kSamples; ++i) {
    const double t = 0.02 * static_cast<double>(i);
    table.columns[0].values[i] = t;
    table.columns[1].values[i] =
        x0 * std::exp(-rate * t) * (std::cos(omega * t) + rate / omega * std::sin(omega * t)) +
        kNoise * noise[i];
  }
  return table;
}

VectorXd makeWhite(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(kSamples, [&](Index) { return normal(random); });
}

VectorXd makeColoured(std::mt19937& random) {
  VectorXd noise = makeWhite(random);
  for (Index i = 1; i < kSamples; ++i) {
    noise[i] = 0.8 * noise[i - 1] + 0.6 * noise[i];
  }
  return noise;
}

VectorXd addSpikes(VectorXd noise) {
  noise[40] += 80.0;
  noise[111] -= 120.0;
  noise[150] += 60.0;
  return noise;
}

/// Recordings of noise that `make` makes, together.
struct Joint {
  explicit Joint(const std::function<VectorXd(std::mt19937&)>& make) {
    std::mt19937 random(3);
    for (std::size_t k = 0; k < kRecordings; ++k) {
      tables.push_back(record(0.8 + 0.3 * static_cast<double>(k), make(random)));
    }
    for (std::size_t k = 0; k < kRecordings; ++k) {
      recordings.push_back({"r" + std::to_string(k), "", &tables[k], {}});
    }
    inferred = JointInferrer(experiment, {}).infer(recordings);
    testModel(experiment, readRecordings(experiment, recordings, {}), inferred);
  }

  Statuses listStatuses() const { return twinmap::listStatuses(inferred, 2); }
  double calcError(Index parameter, double truth) const {
    return std::abs(inferred.joint.mean[parameter] - truth) / inferred.joint.stddev[parameter];
  }
  void expectRight() const {
    EXPECT_LT(calcError(0, kStiffness), 3.0);
    EXPECT_LT(calcError(1, kDamping), 3.0);
    EXPECT_FALSE(inferred.disagrees());
  }

  const ExperimentSpec experiment = makeOscillator();
  std::vector<Table> tables;
  std::vector<Recording> recordings;
  JointInference inferred;
};

TEST(JointFaults, NoneAreFoundOfStatedNoise) {
  const Joint joint(makeWhite);
  EXPECT_EQ(joint.listStatuses(), Statuses{"ok"});
  joint.expectRight();
}

TEST(JointFaults, SpikesAreLeftOutOfEach) {
  const Joint clean(makeWhite), joint([](std::mt19937&random) { return addSpikes(makeWhite(random)); });
  EXPECT_EQ(joint.listStatuses(), Statuses{"outliers"});
  joint.expectRight();
  EXPECT_NEAR(joint.inferred.joint.stddev[0] / clean.inferred.joint.stddev[0], 1.0, 0.1);
}

TEST(JointFaults, OffsetsAreEachRecordingsOwn) {
  double offset = 2.0;
  const Joint joint([&](std::mt19937& random) -> VectorXd {
    offset = -1.5 * offset;
    return makeWhite(random).array() + offset;
  });
  EXPECT_EQ(joint.listStatuses(), Statuses{"sensor_offset"});
  EXPECT_EQ(joint.inferred.findMissing(), nullptr);
  joint.expectRight();
}

TEST(JointFaults, SizeOfTheNoiseIsFound) {
  const Joint clean(makeWhite), joint([](std::mt19937&random) { return VectorXd(2.0 * makeWhite(random)); });
  EXPECT_EQ(joint.listStatuses(), Statuses{"noise_larger"});
  joint.expectRight();
  EXPECT_NEAR(joint.inferred.joint.stddev[0] / clean.inferred.joint.stddev[0], 2.0, 0.3);
}

TEST(JointFaults, ColourWidensTheIntervals) {
  const Joint clean(makeWhite), joint(makeColoured);
  EXPECT_EQ(joint.listStatuses(), Statuses{"noise_coloured"});
  joint.expectRight();
  EXPECT_GT(joint.inferred.joint.stddev[1], 1.5 * clean.inferred.joint.stddev[1]);
}

// With the second recording's own initial state, not with that of the trial that the file chooses.
TEST(JointFaults, RecordingsThatNameTheirTrialsAreOfTheseWhicheverIsChosen) {
  const std::string file = testing::TempDir() + "trials.yaml";
  std::ofstream(file) << R"(
name: oscillator
parameters: {k: {bounds: [30, 80], unit: N/m}, d: {bounds: [0, 2], unit: N s/m}}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
trial: far
trials:
  far: {initial: {coordinates: {x: 1.2}}}
  near: {initial: {coordinates: {x: 0.6}}}
outputs: {x: {coordinate: x}}
simulation: {duration: 4}
features: [{samples: {outputs: [x], start: 0, interval: 0.02, count: 200}}]
noise: {stddev: {x: 0.01}}
)";
  std::mt19937 random(4);
  const std::vector<Table> tables{record(1.2, makeWhite(random)), record(0.6, makeWhite(random))};
  const std::vector<Recording> recordings{{"a", "far", &tables[0], {}}, {"b", "near", &tables[1], {}}};
  JointInference inferred = JointInferrer(loadExperimentTree(file), {}).infer(recordings);
  testModel(file, recordings, {}, inferred);
  ASSERT_TRUE(inferred.model_test);
  EXPECT_FALSE(inferred.model_test->missing);
  EXPECT_EQ(listStatuses(inferred, 2), Statuses{"ok"});
}

/// A diagnosis of recordings of noise that `make` makes.
Diagnosis diagnoseThem(const std::function<VectorXd(std::mt19937&)>& make) {
  const Joint joint(make);
  return diagnoseExplained(
      joint.experiment,
      explainSensors(JointInferrer(joint.experiment, {}), joint.experiment, joint.recordings, {}), {});
}

TEST(JointFaults, AreNotTakenForMissingTerms) {
  const Diagnosis spikes = diagnoseThem([](std::mt19937& random) { return addSpikes(makeWhite(random)); });
  EXPECT_STREQ(spikes.getStatus(), "ok");
  EXPECT_EQ(spikes.found, 0U);
  EXPECT_EQ(spikes.listFaults(), Statuses{"outliers"});
  const Diagnosis coloured = diagnoseThem(makeColoured);
  EXPECT_STREQ(coloured.getStatus(), "noise_coloured");
  EXPECT_EQ(coloured.found, 0U);
  EXPECT_GT(coloured.after.posterior.stddev[1], 1.5 * coloured.before.posterior.stddev[1]);
}

// A force that the model lacks, at a frequency of its own.
TEST(JointFaults, AreSoughtFromTheFirstRecordingWhereAllLackTheSame) {
  std::mt19937 random(5);
  std::vector<Table> tables;
  for (std::size_t k = 0; k < kRecordings; ++k) {
    const VectorXd lacking = VectorXd::NullaryExpr(
        kSamples, [](Index i) { return 40.0 * std::sin(0.02 * 11.0 * static_cast<double>(i)); });
    tables.push_back(record(0.8 + 0.3 * static_cast<double>(k), makeWhite(random) + lacking));
  }
  std::vector<Recording> recordings;
  for (std::size_t k = 0; k < kRecordings; ++k) {
    recordings.push_back({"r" + std::to_string(k), "", &tables[k], {}});
  }
  const JointInferrer inferrer(makeOscillator(), {});
  const auto whole = inferrer.explainAlone(recordings);
  const auto led = inferrer.explainAlone(recordings, JointInferrer::Misfits::kStarts);
  int of_whole = 0, of_led = 0;
  for (std::size_t k = 0; k < kRecordings; ++k) {
    EXPECT_FALSE(whole[k].inferred.posterior->fit->isPlausible());
    EXPECT_NEAR(led[k].posterior.chi_square / whole[k].posterior.chi_square, 1.0, 1e-5);
    of_whole += k > 0 ? whole[k].posterior.simulations : 0;
    of_led += k > 0 ? led[k].posterior.simulations : 0;
  }
  EXPECT_LT(2 * of_led, of_whole);
}

}  // namespace
}  // namespace twinmap
