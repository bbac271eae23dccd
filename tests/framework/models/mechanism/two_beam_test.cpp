#include "tests/framework/models/mechanism/two_beam.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

constexpr int kPoints = 50;

/// Largest difference of each output to the closed form, over the output's range in that trajectory.
double calcLargestError(const ModelSpec& model, int points) {
  const Eigen::VectorXd times = makeTwoBeamTimes();
  const Eigen::MatrixXd parameters = makeTwoBeamPoints(points);
  const Trajectories result = generateSamples(MultibodySimulator(model, times), parameters);
  double largest = 0.0;
  for (int j = 0; j < points; ++j) {
    EXPECT_TRUE(result.statuses[j].ok) << result.statuses[j].reason;
    const Eigen::MatrixXd expected = integrateTwoBeam(parameters.col(j), times);
    for (int o = 0; o < 2; ++o) {
      const auto row = expected.row(o).transpose();
      const double range = row.maxCoeff() - row.minCoeff();
      const double error =
          (result.responses.col(j).segment(o * times.size(), times.size()) - row).cwiseAbs().maxCoeff();
      largest = std::max(largest, error / range);
    }
  }
  return largest;
}

TEST(TwoBeam, OracleIsFarMoreExactThanTheBar) {
  const Eigen::VectorXd times = makeTwoBeamTimes();
  const Eigen::Vector4d point = makeTwoBeamPoints(1).col(0);
  const Eigen::MatrixXd fine = integrateTwoBeam(point, times, 1e-5);
  const Eigen::MatrixXd coarse = integrateTwoBeam(point, times, 1e-4);
  EXPECT_LT((fine - coarse).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(TwoBeam, DefaultToleranceFollowsTheClosedFormWithinTwoHundredThousandths) {
  const double error = calcLargestError(makeTwoBeam(), kPoints);
  RecordProperty("largest_error", std::to_string(error * 1e6) + "e-6");
  EXPECT_LT(error, 2e-5 / 2);  // with margin
}

TEST(TwoBeam, AnyThreadCountAndBatchSizeGivesTheSameBits) {
  const MultibodySimulator simulator(makeTwoBeam(), makeTwoBeamTimes());
  const Eigen::MatrixXd parameters = makeTwoBeamPoints(17);
  const Trajectories reference = generateSamples(simulator, parameters, {1, 1, {}});
  ASSERT_EQ(reference.calcFailureCount(), 0);
  for (const int threads : {1, 2, 3, 5}) {
    for (const int batch : {1, 3, 17}) {
      EXPECT_EQ(generateSamples(simulator, parameters, {threads, batch, {}}).responses, reference.responses);
    }
  }
}

TEST(TwoBeam, SampleDoesNotDependOnWhatWasSimulatedBefore) {
  MultibodySimulator simulator(makeTwoBeam(), makeTwoBeamTimes());
  Eigen::MatrixXd points = makeTwoBeamPoints(2), first(200, 1), again(200, 1), other(200, 1);
  SampleStatus status;
  simulator.simulate(points.col(0), first, &status);
  simulator.simulate(points.col(1), other, &status);
  simulator.simulate(points.col(0), again, &status);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(TwoBeam, HasNamesAndUnits) {
  const MultibodySimulator simulator(makeTwoBeam(), makeTwoBeamTimes());
  EXPECT_EQ(simulator.getLayout().output_names, (std::vector<std::string>{"y", "theta"}));
  EXPECT_EQ(simulator.getLayout().output_units, (std::vector<std::string>{"m", "rad"}));
}

TEST(TwoBeam, UndampedEnergyIsConserved) {
  ModelSpec model = makeTwoBeam();
  model.system.elements.get<Damper>().clear();
  model.excitation[0].pulses[0].amplitude = ex("0");
  model.excitation[1].pulses[0].amplitude = ex("0");
  model.initial.equilibrium.reset();
  start(model, "y", "0.2");
  start(model, "theta", "1");
  model.simulation.relative_tolerance = 1e-9;
  model.outputs = {coordinateOutput("y"), coordinateOutput("theta"), speedOutput("y"), speedOutput("theta")};
  model.outputs.resize(7);
  const Expression3 center = ex3("0", "y_com", "z_com");
  model.outputs[4].velocity = along("beam2", center, ex3("0", "1", "0"));
  model.outputs[5].velocity = along("beam2", center, ex3("0", "0", "1"));
  model.outputs[6].position = along("beam2", center, ex3("0", "0", "1"));
  const Eigen::Vector4d point(1.0, 2e-4, 10.0, 0.036);
  const Eigen::MatrixXd r = runModel(model, Eigen::VectorXd::LinSpaced(101, 0.0, 5.0), point);
  const Eigen::ArrayXd energy = 0.5 * (10.0 * r.col(0).array().square() + 0.036 * r.col(1).array().square() +
                                       3.3 * r.col(2).array().square() + 1.3e-4 * r.col(3).array().square() +
                                       0.13 * (r.col(4).array().square() + r.col(5).array().square())) +
                                0.13 * 9.81 * r.col(6).array();
  EXPECT_LT((energy - energy[0]).abs().maxCoeff(), 1e-7 * std::abs(energy[0]));
}

TEST(TwoBeam, MassesAndLengthsMayBeParameters) {
  // the same trajectory with a mass and an offset as parameters instead of constants
  ModelSpec model = makeTwoBeam();
  const Eigen::Vector4d point = makeTwoBeamPoints(1);
  const Eigen::MatrixXd expected = runModel(model, makeTwoBeamTimes(), point);
  model.constants = {constant("m2", "total - m1"), constant("z_com", "y_com * 22 / 34"),
                     constant("I", "1.3e-4"), constant("g", "9.81")};
  model.parameters.push_back(parameter("total", 3.42, 3.44));
  model.parameters.push_back(parameter("m1", 3.2, 3.4));
  model.parameters.push_back(parameter("y_com", 0.03, 0.038));
  Eigen::VectorXd longer(7);
  longer << point, 3.43, 3.3, 0.034;
  const Eigen::MatrixXd result = runModel(model, makeTwoBeamTimes(), longer);
  EXPECT_LT((result - expected).cwiseAbs().maxCoeff(), 1e-9);
  longer[4] = 3.45;
  EXPECT_GT((runModel(model, makeTwoBeamTimes(), longer) - expected).cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace twinmap::testing
