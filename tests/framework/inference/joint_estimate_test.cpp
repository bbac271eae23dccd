#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/random/random.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/joint/joint_inference.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

constexpr double kNoise = 1e-3;

/// A mass on a spring of 10 N/m, released from .1 m.
std::string makeOscillator(const std::string& parameters, const std::string& mass,
                           const std::string& stiffness) {
  return "name: oscillator\nparameters: " + parameters + "\nsystem:\n  bodies: {cart: {mass: " + mass +
         ", joint: {type: slider, coordinates: [x]}}}\n  springs: [{coordinate: x, stiffness: " + stiffness +
         "}]\ninitial: {coordinates: {x: 0.1}}\noutputs: {x: {coordinate: x}}\nsimulation: {duration: 2}\n"
         "features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 20}}]\n"
         "noise: {stddev: {x: 1e-3}}\n";
}

/// x = .1 cos(w t), with noise.
Table record(const std::string& name, double frequency, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kVerification);
  const VectorXd times = VectorXd::LinSpaced(21, 0.0, 2.0);
  const VectorXd values = VectorXd::NullaryExpr(times.size(), [&](Eigen::Index i) {
    return 0.1 * std::cos(frequency * times[i]) +
           kNoise * random.calcNormal(static_cast<std::uint64_t>(i), 0);
  });
  return {name, {{"t", {}, times}, {"x", {}, values}}, {}};
}

struct Joint {
  std::string text, csv;
  Json json;
};

/// Of two recordings of a machine.
Joint inferTwo(const std::string& experiment, double frequency) {
  const JointInferrer inferrer(parseExperimentTree(experiment, "oscillator.yaml", {}), {});
  const Table a = record("a", frequency, 1), b = record("b", frequency, 2);
  const JointInference inferred = inferrer.infer({{"a", "", &a, {}}, {"b", "", &b, {}}});
  return {makeJointTable(inferred, inferrer.getParameters()),
          makeJointCsvRows(inferred, inferrer.getParameters()),
          parseJson(makeJointJson(inferred, inferrer.getParameters()))};
}

/// The response depends on e^2 alone, so that either sign fits.
TEST(JointEstimates, KeepTheirModes) {
  const Joint joint = inferTwo(makeOscillator("{e: {bounds: [-1, 1], unit: m}}", "1 + e^2", "10"),
                               std::sqrt(10.0 / (1.0 + 0.25)));
  EXPECT_EQ(joint.json["status"], "multimodal");
  ASSERT_EQ(joint.json["components"].size(), 2U);
  for (const Json& component : joint.json["components"]) {
    const Json& e = component["parameters"]["e"];
    EXPECT_NEAR(std::abs(e["mean"].get<double>()), 0.5, 4.0 * e["sd"].get<double>());
    EXPECT_NEAR(component["weight"].get<double>(), 0.5, 0.1);
  }
  EXPECT_EQ(joint.json["parameters"]["e"]["intervals95"].size(), 2U);
  EXPECT_NE(joint.text.find("multimodal, several parameter values may fit"), std::string::npos) << joint.text;
  EXPECT_NE(joint.csv.find("joint,,e,m,"), std::string::npos) << joint.csv;
  EXPECT_FALSE(joint.json.contains("start"));
  EXPECT_EQ(joint.json["trials"].size(), 2U);
}

/// Stiffness and mass act by their quotient, the square of the frequency, whose sd is that of a fit of a
/// cosine's frequency to both.
TEST(JointEstimates, SayWhatCombinationsAreDetermined) {
  const double frequency = std::sqrt(10.0);
  const Joint joint =
      inferTwo(makeOscillator("{k: {bounds: [5, 20], unit: N/m}, m: {bounds: [0.5, 2], unit: kg}}", "m", "k"),
               frequency);
  double information = 0.0;  // of k / m, by d cos(w t) / d w^2
  for (int i = 1; i <= 20; ++i) {
    const double t = 0.1 * i;
    information += 2.0 * std::pow(0.1 * t * std::sin(frequency * t) / (2.0 * frequency * kNoise), 2);
  }
  ASSERT_EQ(joint.json["identified"].size(), 1U) << joint.text;
  const Json& quotient = joint.json["identified"][0];
  EXPECT_EQ(quotient["expression"], "k / m");
  EXPECT_EQ(quotient["unit"], "1/s2");
  EXPECT_NEAR(quotient["sd"].get<double>(), 1.0 / std::sqrt(information), 0.15 / std::sqrt(information));
  EXPECT_NEAR(quotient["mean"].get<double>(), 10.0, 4.0 / std::sqrt(information));
  EXPECT_NE(joint.text.find("of k, m the features determine only k / m"), std::string::npos) << joint.text;
}

}  // namespace
}  // namespace twinmap
