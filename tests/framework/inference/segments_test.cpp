// A driven oscillator x'' = F - k x - d x' in segments, each from a state of its own.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/segments/segment_inference.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 0.02, kNoise = 1e-3;
constexpr int kSamples = 25, kSegments = 12;  // of 0.5 s

const std::string kOscillator = R"(
name: oscillator
parameters:
  k: {bounds: [50, 150], unit: N/m}
  d: {bounds: [0.2, 3], unit: N s/m}
nuisance:
  x0: {bounds: [-0.1, 0.1], unit: m}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
  applied_forces: [{body: cart, force: [F, 0, 0]}]
excitation: {F: {unit: N, tables: [{measured: {file: none.csv, column: F, time: t}, interpolation: hold}]}}
initial: {coordinates: {x: x0}}
outputs: {x: {coordinate: x}}
simulation: {duration: 0.5}
features: [{samples: {outputs: [x], start: 0, interval: 0.02, count: 25}}]
noise: {stddev: {x: 1e-3}}
)";

ExperimentSpec read(const std::string& text) {
  return readExperiment(parseExperimentTree(text, "oscillator.yaml"));
}

double force(int i) {
  return 3.0 * std::sin(1.3 * i) + (i % 40 < 20 ? 4.0 : -4.0);
}

/// The exact step of a held force.
Eigen::Vector2d step(const Eigen::Vector2d& state, double k, double d, double held) {
  const double decay = 0.5 * d, w = std::sqrt(k - decay * decay), rest = held / k;
  const double e = std::exp(-decay * kStep), c = std::cos(w * kStep), s = std::sin(w * kStep);
  const double x = state[0] - rest, v = state[1];
  return {rest + e * (x * c + (v + decay * x) / w * s), e * (v * c - (decay * v + k * x) / w * s)};
}

/// x of `count` samples from a state on, the first force being that of sample `first`.
VectorXd run(Eigen::Vector2d state, double k, double d, int first, int count) {
  VectorXd x(count);
  for (int i = 0; i < count; ++i) {
    x[i] = state[0];
    state = step(state, k, d, force(first + i));
  }
  return x;
}

Table record(int seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kNoise);
  const int count = kSamples * kSegments;
  VectorXd times(count), forces(count), x = run({0.05, 0.2}, 100.0, 1.0, 0, count);
  for (int i = 0; i < count; ++i) {
    times[i] = i * kStep;
    forces[i] = force(i);
    x[i] += noise(random);
  }
  return {"record.csv", {{"t", {}, times}, {"F", {}, forces}, {"x", {}, x}}, {}};
}

/// Of k and d with free initial states, by differences of the exact motion.
MatrixXd calcLimitCovariance() {
  MatrixXd information = MatrixXd::Zero(2, 2);
  Eigen::Vector2d state(0.05, 0.2);
  for (int segment = 0; segment < kSegments; ++segment) {
    const int first = segment * kSamples;
    const auto at = [&](double x, double v, double k, double d) {
      return run(state + Eigen::Vector2d(x, v), 100.0 + k, 1.0 + d, first, kSamples);
    };
    constexpr double h = 1e-4;
    MatrixXd j(kSamples, 4);
    j << at(h, 0, 0, 0) - at(-h, 0, 0, 0), at(0, h, 0, 0) - at(0, -h, 0, 0), at(0, 0, h, 0) - at(0, 0, -h, 0),
        at(0, 0, 0, h) - at(0, 0, 0, -h);
    const MatrixXd all = (j.transpose() * j).inverse() * std::pow(2.0 * h * kNoise, 2);
    information += all.bottomRightCorner(2, 2).inverse();
    for (int i = 0; i < kSamples; ++i) {
      state = step(state, 100.0, 1.0, force(first + i));
    }
  }
  return information.inverse();
}

InferredMeasurement infer(const Table& table, const std::string& text = kOscillator, double length = 0.5) {
  return SegmentInference(read(text), length, VectorXd(0), 256).infer(table, {});
}

TEST(Segments, ReachTheLimitWithFreeInitialStates) {
  const InferredMeasurement inferred = infer(record(3));
  const Estimate estimate = selectEstimate(inferred);
  EXPECT_EQ(estimate.statuses, std::vector<std::string>{"ok"});
  const VectorXd limit = calcLimitCovariance().diagonal().cwiseSqrt();
  const Eigen::Vector2d truth(100.0, 1.0);
  for (Index j = 0; j < 2; ++j) {
    EXPECT_NEAR(estimate.stddev[j] / limit[j], 1.0, 0.1) << j;
    EXPECT_LT(std::abs(estimate.mean[j] - truth[j]), 3.5 * limit[j]) << j;
  }
  EXPECT_EQ(inferred.segments->count, kSegments);
  EXPECT_EQ(inferred.segments->states, 2);
  const SimulatorFit& fit = *inferred.posterior->fit;
  EXPECT_NEAR(fit.degrees, kSamples * kSegments - 2 * kSegments - 2, 0.5);
  EXPECT_EQ(fit.residual.size(), kSamples * kSegments);
}

/// The recording with x other than measured.
template <class Change>
Table change(Table table, Change change) {
  VectorXd& x = table.columns[2].values;
  for (Index i = 0; i < x.size(); ++i) {
    x[i] = change(i, x[i]);
  }
  return table;
}

void expectRight(const InferredMeasurement& inferred, const char* status) {
  const Estimate estimate = selectEstimate(inferred);
  EXPECT_EQ(estimate.statuses, std::vector<std::string>{status});
  EXPECT_LT(std::abs(estimate.mean[0] - 100.0), 3.5 * estimate.stddev[0]) << status;
  EXPECT_LT(std::abs(estimate.mean[1] - 1.0), 3.5 * estimate.stddev[1]) << status;
}

TEST(Segments, LeaveSpikesOut) {
  const InferredMeasurement inferred = infer(change(
      record(3), [](Index i, double x) { return i == 40 || i == 133 || i == 222 ? x + 200.0 * kNoise : x; }));
  expectRight(inferred, "outliers");
  EXPECT_EQ(inferred.posterior->fit->outliers.size(), 3U);
}

TEST(Segments, FindTheSizeOfTheNoise) {
  std::mt19937 random(8);
  std::normal_distribution<double> more(0.0, 2.0 * kNoise);
  const InferredMeasurement inferred =
      infer(change(record(3), [&](Index, double x) { return x + more(random); }));
  expectRight(inferred, "noise_larger");
  EXPECT_NEAR(inferred.posterior->fit->getNoiseFactor(), std::sqrt(5.0), 0.25);
}

TEST(Segments, FindTheOffsetOfASensor) {
  const InferredMeasurement inferred =
      infer(change(record(3), [](Index, double x) { return x + 5.0 * kNoise; }));
  expectRight(inferred, "sensor_offset");
  const FoundNoise& found = inferred.posterior->fit->noise.front().found;
  EXPECT_NEAR(found.offset, 5.0 * kNoise, 4.0 * found.offset_stddev);
  EXPECT_TRUE(inferred.posterior->nuisance.empty());
}

TEST(Segments, FindTheColourOfTheNoise) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0.0, kNoise);
  double error = normal(random);
  const InferredMeasurement inferred = infer(change(record(3), [&](Index i, double) {
    error = 0.7 * error + std::sqrt(1.0 - 0.49) * normal(random);
    return run({0.05, 0.2}, 100.0, 1.0, 0, kSamples * kSegments)[i] + error;
  }));
  expectRight(inferred, "noise_coloured");
  EXPECT_NEAR(inferred.posterior->fit->noise.front().found.autoregression[0], 0.7, 0.15);
}

/// The same where each force is known up to noise: of a segment 1 + G G', G by differences of the exact
/// motion.
MatrixXd calcLimitCovarianceWithNoisyForce(double force_noise) {
  const auto at = [](const Eigen::Vector2d& state, double k, double d, int first, int pushed) {
    VectorXd x(kSamples);
    Eigen::Vector2d now = state;
    for (int i = 0; i < kSamples; ++i) {
      x[i] = now[0];
      now = step(now, k, d, force(first + i) + (i == pushed ? 1.0 : 0.0));
    }
    return x;
  };
  MatrixXd information = MatrixXd::Zero(2, 2);
  Eigen::Vector2d state(0.05, 0.2);
  for (int segment = 0; segment < kSegments; ++segment) {
    const int first = segment * kSamples;
    const VectorXd usual = at(state, 100.0, 1.0, first, -1);
    constexpr double h = 1e-5;
    MatrixXd j(kSamples, 4), g(kSamples, kSamples);
    j << at(state + Eigen::Vector2d(h, 0), 100.0, 1.0, first, -1) - usual,
        at(state + Eigen::Vector2d(0, h), 100.0, 1.0, first, -1) - usual,
        at(state, 100.0 + h, 1.0, first, -1) - usual, at(state, 100.0, 1.0 + h, first, -1) - usual;
    for (int i = 0; i < kSamples; ++i) {
      g.col(i) = force_noise * (at(state, 100.0, 1.0, first, i) - usual);
      state = step(state, 100.0, 1.0, force(first + i));
    }
    const MatrixXd noise = kNoise * kNoise * MatrixXd::Identity(kSamples, kSamples) + g * g.transpose();
    const MatrixXd all = (j.transpose() * noise.inverse() * j).inverse() * h * h;
    information += all.bottomRightCorner(2, 2).inverse();
  }
  return information.inverse();
}

TEST(Segments, CountTheNoiseOfAnExcitation) {
  constexpr double kForceNoise = 0.5;
  const std::string key = "time: t", noisy = "time: t, noise: 0.5";
  std::string text = kOscillator;
  text.replace(text.find(key), key.size(), noisy);
  const VectorXd limit = calcLimitCovarianceWithNoisyForce(kForceNoise).diagonal().cwiseSqrt();
  const VectorXd silent = calcLimitCovariance().diagonal().cwiseSqrt();
  const Eigen::Vector2d truth(100.0, 1.0);
  for (const int seed : {5, 6}) {
    Table table = record(seed);
    std::mt19937 random(100 + seed);
    std::normal_distribution<double> noise(0.0, kForceNoise);
    for (double& value : table.columns[1].values) {
      value += noise(random);
    }
    const InferredMeasurement inferred = infer(table, text);
    const Estimate estimate = selectEstimate(inferred);
    EXPECT_EQ(estimate.statuses, std::vector<std::string>{"ok"});
    for (Index j = 0; j < 2; ++j) {
      EXPECT_GT(limit[j], 1.5 * silent[j]) << j;
      EXPECT_NEAR(estimate.stddev[j] / limit[j], 1.0, 0.15) << j;
      EXPECT_LT(std::abs(estimate.mean[j] - truth[j]), 3.5 * limit[j]) << j;
    }
  }
}

TEST(Segments, DoWithoutSamplesThatAreMissing) {
  Table table = record(4);
  for (const Index i : {Index{25}, Index{26}, Index{40}, Index{130}}) {
    table.columns[2].values[i] = std::nan("");
  }
  const InferredMeasurement inferred = infer(table);
  EXPECT_EQ(selectEstimate(inferred).statuses, std::vector<std::string>{"ok"});
  EXPECT_NEAR(inferred.posterior->fit->degrees, kSamples * kSegments - 4 - 2 * kSegments - 2, 0.5);
}

TEST(Segments, NoticeWhatTheModelLacks) {
  Table table = record(5);
  table.columns[1].values *= 1.1;  // the force as it was not
  EXPECT_EQ(selectEstimate(infer(table)).statuses.front(), "model_mismatch");
}

std::string getError(const std::string& text, double length) {
  try {
    SegmentInference(read(text), length, VectorXd(0), 256);
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

std::string replace(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Segments, SayWhatTheyCannotDo) {
  EXPECT_NE(
      getError(kOscillator, 0.04).find("has 2 samples of 1 outputs, which do not determine its 2 initial"),
      std::string::npos);
  const std::string sticking = replace(
      kOscillator, "  dampers", "  friction: [{coordinate: x, model: coulomb, coulomb: 0.1}]\n  dampers");
  EXPECT_NE(getError(sticking, 0.5).find("friction that sticks"), std::string::npos);
  const std::string late =
      replace(kOscillator, "{x: {coordinate: x}}", "{x: {coordinate: x, sensor: {lag: 0.01}}}");
  EXPECT_NE(getError(late, 0.5).find("sensor of output 'x'"), std::string::npos);
  const std::string peaks = replace(kOscillator, "features: [",
                                    "features: [{statistics: {outputs: [x], window: {start: 0, interval: "
                                    "0.1, count: 5}, quantities: [mean]}}, ");
  EXPECT_NE(getError(peaks, 0.5).find("leave only 'samples'"), std::string::npos);
  EXPECT_EQ(getError(kOscillator, 0.5), "");
}

const std::string kRubbing = R"(
name: rubbing_cart
parameters:
  m: {bounds: [1.5, 2.5], unit: kg}
  s0: {bounds: [5e3, 2e4], unit: N/m}
  Fc: {bounds: [1, 3], unit: N}
system:
  bodies: {cart: {mass: m, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: 50}]
  friction:
    - {coordinate: x, model: lugre, coulomb: Fc, viscous: 0.1, bristle: {stiffness: s0, damping: 20}}
  applied_forces: [{body: cart, force: [F, 0, 0]}]
excitation: {F: {unit: N, sines: [{amplitude: 8, frequency: 1.5}]}}
outputs: {x: {coordinate: x}}
simulation: {duration: 0.8}
features: [{samples: {outputs: [x], start: 0, interval: 0.01, count: 80}}]
noise: {stddev: {x: 2e-5}}
)";

/// x of the cart, by Runge and Kutta's method in steps that its bristle needs.
VectorXd rub(double m, double s0, double coulomb, int count) {
  constexpr int kSubsteps = 400;
  constexpr double h = 0.01 / kSubsteps;
  const auto rate = [&](double t, const Eigen::Vector3d& y) {
    const double change = y[1] - s0 * std::abs(y[1]) * y[2] / coulomb;
    const double friction = s0 * y[2] + 20.0 * change + 0.1 * y[1];
    return Eigen::Vector3d(y[1], (8.0 * std::sin(3.0 * M_PI * t) - 50.0 * y[0] - friction) / m, change);
  };
  VectorXd x(count);
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  for (int i = 0; i < count * kSubsteps; ++i) {
    if (i % kSubsteps == 0) {
      x[i / kSubsteps] = y[0];
    }
    const double t = i * h;
    const Eigen::Vector3d a = rate(t, y), b = rate(t + h / 2, y + h / 2 * a),
                          c = rate(t + h / 2, y + h / 2 * b), e = rate(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + e);
  }
  return x;
}

// A bristle goes no farther than where it slides; one segment alone tells how far the cart goes.
TEST(Segments, BeginWithBristlesWithinTheirReach) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 2e-5);
  VectorXd x = rub(2.1, 1.2e4, 1.7, 80);
  x += VectorXd::NullaryExpr(80, [&] { return noise(random); });
  const Table table{"record.csv", {{"t", {}, VectorXd::LinSpaced(80, 0.0, 0.79)}, {"x", {}, x}}, {}};
  const Estimate estimate = selectEstimate(infer(table, kRubbing, 0.8));
  EXPECT_EQ(estimate.statuses, std::vector<std::string>{"ok"});
  const Eigen::Vector3d truth(2.1, 1.2e4, 1.7);
  for (Index j = 0; j < 3; ++j) {
    EXPECT_LT(std::abs(estimate.mean[j] - truth[j]), 4.0 * estimate.stddev[j]) << j;
  }
  EXPECT_LT(estimate.stddev[0], 1e-3);
}

TEST(Segments, NeedARecordingOfOneSegmentAtLeast) {
  EXPECT_THROW(infer(record(6), kOscillator, 20.0), ExperimentError);
}

}  // namespace
}  // namespace twinmap
