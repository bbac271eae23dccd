#include "framework/diagnosis/held_out.hpp"

#include <gtest/gtest.h>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/diagnosis/remainder/remainder.hpp"
#include "framework/diagnosis/structures.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const char* const kHeldSound = "F - k3*x^3";
const char* const kHeldWithFriction = "F - k3*x^3 - 0.03*tanh(x_dot/0.01)";
const char* const kWithFrictionSought = "F - k3*x^3 - friction*tanh(x_dot/0.01)";
const VectorXd kHeldTruth = Eigen::Vector3d(95.0, 1.2, 2500.0);

/// The cart with another force law, measured.
RecordedFeatures measureHeld(const std::string& force, std::uint64_t seed) {
  const ExperimentSpec machine = loadExperiment(kCart, {"system.force_laws[0].force=" + force});
  const ResponseLayout layout = makeLayout(machine);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(machine.model, layout.times)->simulate(kHeldTruth, response, &status);
  const MatrixXd noisy =
      addNoise(response, ResponseNoise(machine.noise, layout), {seed, RandomPurpose::kTestNoise});
  return {layout, {makeExtractor(machine, layout).extract(noisy).col(0)}, {}};
}

TEST(HeldOut, IsPredictedWithinTheNoiseByASoundModel) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const KnownMachine machine = inferMachine(experiment, measureHeld(kHeldSound, 1), {});
  const HeldOutPrediction prediction = predictHeldOut(experiment, measureHeld(kHeldSound, 2), machine);
  EXPECT_GT(prediction.p_value, 1e-3);
  EXPECT_NEAR(prediction.rms, 1.0, 0.2);
  EXPECT_NEAR(prediction.output_rms[0], prediction.rms, 1e-12);
  EXPECT_GT(prediction.nominal_rms, 2.0 * prediction.rms);
}

// A model without friction fits the damping to one test; what it predicts of a machine with friction is off.
TEST(HeldOut, ShowsWhatAModelLacks) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const KnownMachine machine = inferMachine(experiment, measureHeld(kHeldWithFriction, 1), {});
  EXPECT_LT(predictHeldOut(experiment, measureHeld(kHeldWithFriction, 2), machine).p_value, 1e-3);
}

TEST(HeldOut, IsHeldToTheFitWhereTheSizeOfNoiseIsUnknown) {
  const ExperimentSpec unknown = loadExperiment(kCart, {"noise.stddev.x=unknown"});
  const ExperimentSpec sized = sizeNoiseByFit(unknown, measureHeld(kHeldSound, 1), {});
  EXPECT_NEAR(sized.noise.stddev[0].stddev.value, 1e-4, 3e-5);  // of the cart; 4 sd of a hundred samples
  const KnownMachine machine = inferMachine(sized, measureHeld(kHeldSound, 1), {});
  EXPECT_GT(predictHeldOut(sized, measureHeld(kHeldSound, 2), machine).p_value, 1e-3);
  EXPECT_LT(predictHeldOut(sized, measureHeld(kHeldWithFriction, 2), machine).p_value, 1e-3);
}

TEST(HeldOut, NeedsSamplesToPredict) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const RecordedFeatures recording = measureHeld(kHeldSound, 1);
  const KnownMachine machine{kHeldTruth, MatrixXd::Identity(3, 3)};
  EXPECT_THROW(predictHeldOut(experiment, recording, machine, 1e6), std::runtime_error);
}

TEST(Structures, AreChosenByEvidenceAndPrediction) {
  const RecordedFeatures recording = measureHeld(kHeldWithFriction, 1);
  const StructureFit without = calcStructureFit(loadExperiment(kCart), recording, {});
  const StructureFit with = calcStructureFit(
      loadExperiment(kCart, {std::string("system.force_laws[0].force=") + kWithFrictionSought,
                             "parameters.friction={bounds: [0, 0.1], unit: N}"}),
      recording, {});
  EXPECT_GT(with.log_evidence, without.log_evidence + 10.0);
  EXPECT_LT(with.held_out_rms, without.held_out_rms);
  EXPECT_GT(with.held_out_p, 1e-3);
}

// Where nothing is missing, a parameter that does nothing costs evidence.
TEST(Structures, PayForParametersThatDoNothing) {
  const RecordedFeatures recording = measureHeld(kHeldSound, 1);
  const StructureFit plain = calcStructureFit(loadExperiment(kCart), recording, {});
  const StructureFit richer = calcStructureFit(
      loadExperiment(kCart, {std::string("system.force_laws[0].force=") + kWithFrictionSought,
                             "parameters.friction={bounds: [0, 0.1], unit: N}"}),
      recording, {});
  EXPECT_GT(plain.log_evidence, richer.log_evidence);
}

// Two estimates 2 apart with sds of 0: variance between them 2, sd of the mean 1, by hand.
TEST(RandomEffects, AreThoseOfTheScatter) {
  const RandomEffects apart = calcRandomEffects(Eigen::Vector2d(1.0, 3.0), Eigen::Vector2d(1e-6, 1e-6));
  EXPECT_NEAR(apart.mean, 2.0, 1e-9);
  EXPECT_NEAR(apart.between, std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(apart.stddev, 1.0, 1e-9);
  const RandomEffects alike = calcRandomEffects(Eigen::Vector2d(1.0, 1.1), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(alike.between, 0.0);
  EXPECT_NEAR(alike.stddev, 1.0 / std::sqrt(1.25), 1e-12);
}

}  // namespace
}  // namespace twinmap
