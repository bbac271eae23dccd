// Natural frequencies and damping ratios against closed forms.
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <complex>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

constexpr double kTwoPi = 6.283185307179586;
// central differences of forces that are linear leave rounding errors alone: 1e-16 / 6e-6 of the stiffness
constexpr double kTolerance = 1e-9;
const Expression3 kAlongX = ex3("1", "0", "0");

struct Modes {
  Eigen::VectorXd frequencies, damping_ratios;
  std::string reason;
};

Modes calcModes(const ModelSpec& model, int count, const Eigen::VectorXd& parameters = Eigen::VectorXd()) {
  MultibodySimulator simulator(model, Eigen::VectorXd(), count);
  Eigen::MatrixXd response(2 * count, 1);
  SampleStatus status;
  simulator.simulate(parameters, response, &status);
  EXPECT_EQ(status.ok, response.allFinite());
  return {response.col(0).head(count), response.col(0).tail(count), status.reason};
}

/// A chain of masses on sliders, each relative to the one before, fixed at its first end.
ModelSpec makeChain(const std::vector<std::string>& masses, const std::vector<std::string>& stiffnesses,
                    const std::vector<std::string>& dampings) {
  ModelSpec model;  // no duration: nothing is integrated
  model.system.gravity = kOrigin;
  std::string parent = "ground";
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    model.system.bodies.push_back(body("mass" + number, masses[i], kOrigin, kOrigin,
                                       joint(JointType::kSlider, kAlongX, {"x" + number}, parent)));
    parent = "mass" + number;
    model.system.elements.get<Spring>().push_back({name("x" + number), ex(stiffnesses[i]), ex("0")});
    model.system.elements.get<Damper>().push_back({name("x" + number), ex(dampings[i])});
  }
  return model;
}

TEST(Linearization, OfAUniformChainHasItsClosedFormModes) {
  // omega_i = 2 sqrt(k / m) sin((2 i - 1) pi / (2 (2 n + 1))); dampers d = beta k give beta omega / 2
  const Modes modes = calcModes(makeChain({"2", "2", "2"}, {"800", "800", "800"}, {"4", "4", "4"}), 3);
  for (int i = 1; i <= 3; ++i) {
    const double omega = 2.0 * std::sqrt(800.0 / 2.0) * std::sin((2 * i - 1) * kTwoPi / 28.0);
    EXPECT_NEAR(modes.frequencies[i - 1], omega / kTwoPi, kTolerance * omega);
    EXPECT_NEAR(modes.damping_ratios[i - 1], 0.5 * 4.0 / 800.0 * omega, kTolerance);
  }
}

TEST(Linearization, OfAChainWithAnyDampersSolvesTheQuadraticEigenproblem) {
  // in absolute displacements: (lambda^2 M + lambda C + K) v = 0
  const Eigen::Vector3d m(2.0, 1.0, 0.5), k(900.0, 1100.0, 1000.0), d(3.0, 40.0, 7.0);
  const auto assemble = [](const Eigen::Vector3d& s) {
    Eigen::Matrix3d matrix;
    matrix << s[0] + s[1], -s[1], 0, -s[1], s[1] + s[2], -s[2], 0, -s[2], s[2];
    return matrix;
  };
  const Modes modes = calcModes(makeChain({"2", "1", "0.5"}, {"900", "1100", "1000"}, {"3", "40", "7"}), 3);
  for (int i = 0; i < 3; ++i) {
    const double omega = kTwoPi * modes.frequencies[i], zeta = modes.damping_ratios[i];
    const std::complex<double> lambda(-zeta * omega, omega * std::sqrt(1.0 - zeta * zeta));
    const Eigen::Matrix3cd pencil = lambda * lambda * Eigen::Matrix3d(m.asDiagonal()) + lambda * assemble(d) +
                                    assemble(k).cast<std::complex<double>>();
    const Eigen::Vector3d singular = pencil.jacobiSvd().singularValues();
    EXPECT_LT(singular[2], kTolerance * singular[0]) << i;
  }
  EXPECT_LT(modes.frequencies[0], modes.frequencies[1]);
  EXPECT_LT(modes.frequencies[1], modes.frequencies[2]);
}

TEST(Linearization, IsAtEachSamplesOwnEquilibrium) {
  // a hardening spring under gravity: k q + c q^3 = m g
  ModelSpec model = makeModel(0.0);
  model.parameters = {parameter("c", 1e3, 1e5)};
  model.system.gravity = ex3("9.81", "0", "0");
  model.system.bodies = {body("mass", "2", kOrigin, kOrigin, joint(JointType::kSlider, kAlongX, {"q"}))};
  model.system.elements.get<Spring>() = {{name("q"), ex("100"), ex("0")}};
  model.system.elements.get<ForceLaw>() = {law("q", "-c * q^3")};
  model.initial.equilibrium = EquilibriumSpec{};  // at the box centre: where Newton's method starts
  for (const double c : {2e3, 9e4}) {
    double q = 0.1;
    for (int i = 0; i < 100; ++i) {
      q -= (100.0 * q + c * q * q * q - 2.0 * 9.81) / (100.0 + 3.0 * c * q * q);
    }
    const double omega = std::sqrt((100.0 + 3.0 * c * q * q) / 2.0);
    // the cubic force leaves h^2 c of the stiffness
    EXPECT_NEAR(kTwoPi * calcModes(model, 1, Eigen::VectorXd::Constant(1, c)).frequencies[0], omega,
                1e-8 * omega);
  }
}

TEST(Linearization, IgnoresTheExcitation) {
  ModelSpec model = makeChain({"2"}, {"800"}, {"4"});
  model.excitation = {pulse("F", "500", "0", "1")};
  model.system.elements.get<ForceLaw>() = {law("x1", "F * (1 + x1)")};
  EXPECT_NEAR(kTwoPi * calcModes(model, 1).frequencies[0], 20.0, 1e-7);
}

TEST(Linearization, OfAPendulumOnABallJointKnowsItsAngles) {
  // hanging along -y: two equal modes, and a free spin that does not count
  ModelSpec model = makeModel(0.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {body("bob", "1.5", ex3("0", "-0.4", "0"), ex3("0.02", "0.01", "0.02"),
                              joint(JointType::kBall, {"a", "b", "c"}))};
  const double omega = std::sqrt(1.5 * 9.81 * 0.4 / (0.02 + 1.5 * 0.16));
  const Modes modes = calcModes(model, 2);
  EXPECT_NEAR(kTwoPi * modes.frequencies[0], omega, 1e-8 * omega);
  EXPECT_NEAR(kTwoPi * modes.frequencies[1], omega, 1e-8 * omega);
  EXPECT_NEAR(modes.damping_ratios[1], 0.0, 1e-8);
  EXPECT_EQ(calcModes(model, 3).reason, "only 2 of 3 modes oscillate at the equilibrium");
}

TEST(Linearization, LeavesOutOverdampedAndRigidMotions) {
  EXPECT_EQ(calcModes(makeChain({"1"}, {"100"}, {"30"}), 1).reason,
            "only 0 of 1 modes oscillate at the equilibrium");
  const Modes modes = calcModes(makeChain({"1", "1"}, {"0", "100"}, {"0", "0"}), 1);
  EXPECT_NEAR(kTwoPi * modes.frequencies[0], std::sqrt(200.0), 1e-7);  // two free masses
  EXPECT_EQ(calcModes(makeChain({"1", "1"}, {"0", "100"}, {"0", "0"}), 2).reason,
            "only 1 of 2 modes oscillate at the equilibrium");
}

TEST(Linearization, StandsBesideASimulationInTime) {
  ModelSpec model = makeChain({"2"}, {"800"}, {"0"});
  model.simulation.duration = 1.0;
  model.outputs = {coordinateOutput("x1")};
  start(model, "x1", "0.1");
  MultibodySimulator simulator(model, Eigen::Vector2d(0.5, 1.0), 1);
  Eigen::MatrixXd response(4, 1);
  SampleStatus status;
  simulator.simulate(Eigen::VectorXd(), response, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  EXPECT_NEAR(response(0), 0.1 * std::cos(10.0), 1e-6);
  EXPECT_NEAR(response(1), 0.1 * std::cos(20.0), 1e-6);
  EXPECT_NEAR(response(2), 20.0 / kTwoPi, 1e-8);
  EXPECT_NEAR(response(3), 0.0, 1e-8);
}

}  // namespace
}  // namespace twinmap::testing
