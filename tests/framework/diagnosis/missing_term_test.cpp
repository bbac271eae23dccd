#include "framework/diagnosis/missing_term.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/measurement/direct_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Statuses = std::vector<std::string>;

const std::string kReleased =
    std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/released_pendulum.yaml";

/// The cart's measurement, inferred and tested.
struct TestedCart {
  ExperimentSpec experiment;
  InferredMeasurement inferred;

  Statuses listStatuses() const { return twinmap::listStatuses(inferred); }
  std::string describe() const {
    return describeTrust(inferred, experiment.model.parameters,
                         MeasurementReader(experiment).getExtractor().getInfos());
  }
};

TestedCart testCart(const Eigen::VectorXd& features, const std::vector<std::string>& overrides = {}) {
  TestedCart cart{loadExperiment(kCart, overrides), {}};
  const MeasurementReader reader(cart.experiment);
  cart.inferred = DirectInference(reader).infer(features, {});
  testModel(cart.experiment, {makeLayout(cart.experiment), {features}, {}}, cart.inferred);
  return cart;
}

TEST(MissingTerm, IsNoneWhereNothingIsMissing) {
  const TestedCart cart = testCart(measureCart(kSound));
  EXPECT_EQ(cart.listStatuses(), Statuses{"ok"});
  ASSERT_TRUE(cart.inferred.model_test);
  EXPECT_EQ(cart.inferred.findMissing(), nullptr);
  ASSERT_TRUE(cart.inferred.model_test->unnoticed);
  EXPECT_GT(cart.inferred.model_test->unnoticed->shift, 1.0);
  EXPECT_NE(cart.describe().find("could go unnoticed: "), std::string::npos);
}

TEST(MissingTerm, IsNamedThoughNoiseWouldExplainTheMeasurement) {
  const TestedCart cart = testCart(measureCart("F - k3*x^3 - 0.004*tanh(x_dot/0.01)"));
  const MissingTerm* missing = cart.inferred.findMissing();
  ASSERT_NE(missing, nullptr);
  EXPECT_EQ(cart.listStatuses(), Statuses{"missing_term"});
  EXPECT_GT(cart.inferred.posterior->fit->test.calcPValue(), kMismatchLevel);
  EXPECT_GT(missing->log_evidence, 3.0);
  EXPECT_LT(missing->shifts[1], -1.0);  // the damping had taken up the friction
  EXPECT_NE(cart.describe().find("d would fall by"), std::string::npos);
}

/// A pendulum let go, with a bristle on its joint that slips at a moment `level`.
Eigen::VectorXd measureBristle(const std::string& level) {
  const ExperimentSpec machine =
      loadExperiment(kReleased, {"system.friction=[{coordinate: angle, model: lugre, coulomb: " + level +
                                 ", bristle: {state: z, stiffness: 0.1, damping: 0}}]"});
  const ResponseLayout layout = makeLayout(machine);
  Eigen::MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(machine.model, layout.times)
      ->simulate(calcBoxCenter(collectSampled(machine.model)), response, &status);
  return makeExtractor(machine, layout)
      .extract(addNoise(response, ResponseNoise(machine.noise, layout), {1, RandomPurpose::kTestNoise}))
      .col(0);
}

TEST(MissingTerm, IsAskedWithStatesWhereTheResidualIsSuspicious) {
  const ExperimentSpec model = loadExperiment(kReleased, {});
  const auto infer = [&](const Eigen::VectorXd& features) {
    InferredMeasurement inferred = DirectInference(MeasurementReader(model)).infer(features, {});
    testModel(model, {makeLayout(model), {features}, {}}, inferred);
    return inferred;
  };
  const InferredMeasurement sticking = infer(measureBristle("5e-3"));
  ASSERT_NE(sticking.findMissing(), nullptr);
  const std::string& term = sticking.findMissing()->term;
  EXPECT_TRUE(term == "lugre.angle" || term == "hysteresis.angle") << term;
  EXPECT_EQ(infer(measureBristle("1e-6")).findMissing(), nullptr);
}

TEST(MissingTerm, GoesBeforeNoiseOfAnotherKind) {
  const Eigen::VectorXd features = measureCart("F - k3*x^3 - 0.007*tanh(x_dot/0.01)");
  const Statuses of_noise =
      listStatuses(DirectInference(MeasurementReader(loadExperiment(kCart, {}))).infer(features, {}));
  ASSERT_NE(of_noise, Statuses{"ok"});
  ASSERT_NE(of_noise, Statuses{"model_mismatch"});
  const TestedCart cart = testCart(features);
  EXPECT_EQ(cart.listStatuses(), Statuses{"missing_term"});
  EXPECT_TRUE(cart.inferred.findMissing()->explains);
}

TEST(MissingTerm, IsNotNamedWhereTheNoiseIsColoured) {
  const TestedCart cart =
      testCart(measureCart(kSound, 0, {"noise.correlation={x: {autoregression: [0.7]}}"}));
  EXPECT_EQ(cart.listStatuses(), Statuses{"noise_coloured"});
}

TEST(MissingTerm, ExplainsAMisfitAsWell) {
  const TestedCart cart = testCart(measureCart(kWithFriction));
  EXPECT_EQ(cart.listStatuses().front(), "model_mismatch");
  ASSERT_NE(cart.inferred.findMissing(), nullptr);
  EXPECT_EQ(cart.inferred.findMissing()->term, "coulomb.x");
  EXPECT_GT(cart.inferred.findMissing()->share, 0.9);
}

/// Two recordings together.
JointInference testJointly(const std::string& force) {
  const ExperimentSpec experiment = loadExperiment(kCart, {});
  const RecordedFeatures recordings{makeLayout(experiment), {measureCart(force), measureCart(force, 1)}, {}};
  const RecordingsProblem problem(experiment, recordings);
  JointInference inferred;
  inferred.alone.resize(2);
  inferred.joint = samplePosterior(problem.get(), Eigen::MatrixXd(3, 0), {});
  testModel(experiment, recordings, inferred);
  return inferred;
}

TEST(MissingTerm, IsNamedOfRecordingsTogetherThatEachAloneDoNotShow) {
  const char* const slight = "F - k3*x^3 - 0.003*tanh(x_dot/0.01)";
  EXPECT_EQ(testCart(measureCart(slight)).listStatuses(), Statuses{"ok"});
  const JointInference joint = testJointly(slight);
  ASSERT_NE(joint.findMissing(), nullptr);
  EXPECT_LT(joint.findMissing()->shifts[1], -1.0);
  EXPECT_EQ(testJointly(kSound).findMissing(), nullptr);
}

TEST(MissingTerm, IsNotAskedForWithoutASimulation) {
  const Eigen::VectorXd features = measureCart(kSound);
  InferredMeasurement by_map;
  by_map.by_estimator.mean = kTrueCart;
  const ExperimentSpec experiment = loadExperiment(kCart, {});
  testModel(experiment, {makeLayout(experiment), {features}, {}}, by_map);
  EXPECT_FALSE(by_map.model_test);
}

}  // namespace
}  // namespace twinmap
