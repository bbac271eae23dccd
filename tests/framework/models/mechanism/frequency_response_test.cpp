// Frequency response features of a simulated chain against C (j w I - A)^-1 B.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <complex>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "framework/simulation/excitation/calc_input_signals.hpp"

namespace twinmap {
namespace {

constexpr double kTwoPi = 6.283185307179586;
const std::string kFile =
    std::string(TWINMAP_SOURCE_DIR) + "/experiments/three_mass_chain/frequency_response.yaml";

Eigen::Matrix3d assemble(double s1, double s2, double s3) {
  Eigen::Matrix3d matrix;
  matrix << s1 + s2, -s2, 0, -s2, s2 + s3, -s3, 0, -s3, s3;
  return matrix;
}

/// Absolute displacements of the three masses per N on the third: C (j w I - A)^-1 B with
/// A = [0, 1; -M^-1 K, -M^-1 D]. point: k1, k2, k3, m2, d2.
Eigen::Vector3cd calcFrequencyResponse(const Eigen::VectorXd& point, double frequency) {
  const Eigen::Matrix3d inverse_mass = Eigen::Vector3d(1 / 2.0, 1 / point[3], 1 / 0.5).asDiagonal();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6, 6);
  a.topRightCorner(3, 3).setIdentity();
  a.bottomLeftCorner(3, 3) = -inverse_mass * assemble(point[0], point[1], point[2]);
  a.bottomRightCorner(3, 3) = -inverse_mass * assemble(10.0, point[4], 10.0);
  Eigen::VectorXcd b = Eigen::VectorXcd::Zero(6);
  b[5] = 1 / 0.5;
  const std::complex<double> jw(0.0, kTwoPi * frequency);
  const Eigen::MatrixXcd resolvent = jw * Eigen::MatrixXcd::Identity(6, 6) - a.cast<std::complex<double>>();
  return resolvent.partialPivLu().solve(b).head(3);
}

TEST(FrequencyResponse, OfASimulatedChainIsThatOfItsMatrices) {
  const ExperimentSpec experiment =
      loadExperiment(kFile, {"simulation.relative_tolerance=1e-9", "simulation.absolute_tolerance=1e-12",
                             "simulation.duration=16", "features[0].frequency_response.window.start=14"});
  MultibodySimulator simulator(experiment.model, collectTimes(experiment.features));
  const FeatureExtractor extractor(experiment.features, simulator.getLayout(),
                                   calcInputSignals(experiment.model, simulator.getLayout().times));
  const Eigen::VectorXd point = (Eigen::VectorXd(5) << 850, 1150, 950, 1.1, 9).finished();
  Eigen::MatrixXd response(simulator.getLayout().getRowCount(), 1);
  SampleStatus status;
  simulator.simulate(point, response, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  const Eigen::VectorXd found = extractor.extract(response);

  // After 14 s the slowest transient, real part -1.09 1/s, is exp(-15) = 2.4e-7 of the response to 16 sines,
  // some 0.02 m, and the integration errs by 1e-9 of it a step.
  constexpr double kTolerance = 2e-8;
  const auto& lines = std::get<FrequencyResponseFeatureSpec>(experiment.features[0]).frequencies;
  const auto count = static_cast<Eigen::Index>(lines.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3cd expected = calcFrequencyResponse(point, lines[i].hertz);
    EXPECT_NEAR(found[2 * i], expected[0].real(), kTolerance) << lines[i].hertz;
    EXPECT_NEAR(found[2 * i + 1], expected[0].imag(), kTolerance) << lines[i].hertz;
    EXPECT_NEAR(found[2 * (count + i)], expected[2].real(), kTolerance) << lines[i].hertz;
    EXPECT_NEAR(found[2 * (count + i) + 1], expected[2].imag(), kTolerance) << lines[i].hertz;
  }
}

TEST(InputSignals, AreThoseOfTheExcitationWithJumpsTakenFromBehind) {
  ModelSpec model;
  model.simulation.duration = 3.0;
  SignalSpec pulse, sine;
  pulse.name.text = "P";
  pulse.unit = "N";
  pulse.pulses.push_back({{"2", {}}, {"1", {}}, {"2", {}}});
  sine.name.text = "S";
  sine.sines.push_back({});
  sine.sines[0].amplitude.text = "3";
  sine.sines[0].frequency.text = "0.25";
  model.excitation = {pulse, sine};
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(4, 0.0, 3.0);
  const InputSignals inputs = calcInputSignals(model, times);
  Eigen::MatrixXd expected(4, 2);
  expected << 0, 0, 2, 3, 0, 0, 0, -3;
  EXPECT_LT((inputs.values - expected).norm(), 1e-14);
  EXPECT_EQ(inputs.names, (std::vector<std::string>{"P", "S"}));
  EXPECT_EQ(inputs.units, (std::vector<std::string>{"N", ""}));
}

}  // namespace
}  // namespace twinmap
