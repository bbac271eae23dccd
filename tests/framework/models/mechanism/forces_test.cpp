// Force elements, force laws and station outputs against closed forms and conserved quantities.

#include <cmath>
#include <complex>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

ModelSpec makeBlock(const std::string& mass, double duration) {
  ModelSpec model = makeModel(duration);
  model.system.bodies = {body("block", mass, kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.outputs = {coordinateOutput("x"), speedOutput("x")};
  return model;
}

TEST(ForceLaws, CubicSpringHasItsEllipticPeriod) {
  // m x'' = -k x^3 from rest at A: quarter period K(1 / sqrt 2) sqrt(m / k) / A
  ModelSpec model = makeBlock("2", 10.0);
  model.constants = {constant("k", "8")};
  model.system.elements.get<ForceLaw>() = {law("x", "-k * x^3")};
  start(model, "x", "0.5");
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(2.0 / 8.0) / 0.5;
  Eigen::VectorXd times(2);
  times << quarter, 2.0 * quarter;
  const Eigen::MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 0), 0.0, 1e-8);
  EXPECT_NEAR(result(1, 0), -0.5, 1e-8);
}

TEST(ForceLaws, SmoothDryFrictionStopsABlock) {
  // m v' = -f tanh(v / w): sinh(v / w) = sinh(v0 / w) exp(-f t / (m w))
  ModelSpec model = makeBlock("2", 1.0);
  model.system.elements.get<ForceLaw>() = {law("x", "-3 * tanh(x_dot / 0.05)")};
  start(model, "x", "0", "0.4");
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(11, 0.0, 1.0);
  const Eigen::MatrixXd result = runModel(model, times);
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double expected = 0.05 * std::asinh(std::sinh(8.0) * std::exp(-30.0 * times[i]));
    EXPECT_NEAR(result(i, 1), expected, 1e-8);
  }
}

TEST(ForceLaws, KnowTheTimeAndTheSignals) {
  ModelSpec model = makeBlock("2", 2.0);
  model.excitation = {pulse("F", "3", "0.5", "1")};
  model.system.elements.get<ForceLaw>() = {law("x", "6 * t + 2 * F")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(result(0, 0), 0.5 * 8.0 + 3.0 * (0.125 + 0.5 * 1.0), 1e-9);  // t^3 / 2 + the pulse
  EXPECT_NEAR(result(0, 1), 1.5 * 4.0 + 3.0 * 0.5, 1e-9);
}

TEST(ForceLaws, OfASpringAndADamperOnAMovingBaseAreTheirClosedForm) {
  // m x'' = k (z - x) + d (z' - x') with z = A sin(w t), from rest
  const double m = 2.0, k = 200.0, d = 1.5, A = 0.02, w = 9.0;
  ModelSpec model = makeBlock("2", 3.0);
  SignalSpec base;
  base.name = name("z");
  base.sines.push_back({ex("0.02"), ex("9 / (2 * pi)"), ex("0"), ex("0"), {"", {}}});
  model.excitation = {base};
  model.system.elements.get<ForceLaw>() = {law("x", "200 * (z - x) + 1.5 * (z_dot - x_dot)")};
  const std::complex<double> i(0.0, 1.0);
  const std::complex<double> forced = A * (k + i * w * d) / (k - m * w * w + i * w * d);
  const double a = 0.5 * d / m, wd = std::sqrt(k / m - a * a);
  // x = Im(forced e^(i w t)) + e^(-a t) (b cos(wd t) + c sin(wd t))
  const double b = -forced.imag(), c = (-w * forced.real() + a * b) / wd;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(9, 0.3, 3.0);
  const Eigen::MatrixXd result = runModel(model, times);
  for (Eigen::Index row = 0; row < times.size(); ++row) {
    const double t = times[row];
    const double expected = (forced * std::exp(i * w * t)).imag() +
                            std::exp(-a * t) * (b * std::cos(wd * t) + c * std::sin(wd * t));
    EXPECT_NEAR(result(row, 0), expected, 1e-9);
  }
}

TEST(Forces, AppliedForceMayTurnWithItsBody) {
  // the body spins at 2 rad/s under a force along its own x: x'' = F cos(2 t) / m, y'' = F sin(2 t) / m
  ModelSpec model = makeModel(1.5);
  model.system.bodies = {
      body("rocket", "4", kOrigin, ex3("1", "1", "1"), joint(JointType::kPlanar, {"turn", "x", "y"}))};
  model.system.elements.get<AppliedForce>() = {
      {station("rocket", kOrigin), ex3("6", "0", "0"), ForceFrame::kBody}};
  start(model, "turn", "0", "2");
  model.outputs = {coordinateOutput("x"), coordinateOutput("y")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 1.5));
  EXPECT_NEAR(result(0, 0), 1.5 / 4.0 * (1.0 - std::cos(3.0)), 1e-9);
  EXPECT_NEAR(result(0, 1), 1.5 / 4.0 * (3.0 - std::sin(3.0)), 1e-9);
}

TEST(Forces, AppliedForceOffTheOriginTurnsTheBody) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("disc", "4", kOrigin, ex3("1", "1", "2"), joint(JointType::kPin, {"turn"}))};
  model.system.elements.get<AppliedForce>() = {
      {station("disc", ex3("0.5", "0", "0")), ex3("0", "3", "0"), ForceFrame::kBody}};
  model.outputs = {coordinateOutput("turn")};
  EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 0), 0.5 * 1.5 / 2.0, 1e-10);
}

TEST(Forces, AppliedMomentActsInEitherFrame) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {
      body("disc", "4", kOrigin, ex3("2", "2", "2"), joint(JointType::kPin, ex3("1", "0", "0"), {"turn"}))};
  model.system.elements.get<AppliedMoment>() = {{name("disc"), ex3("1", "5", "7"), ForceFrame::kGround},
                                                {name("disc"), ex3("0.5", "5", "7"), ForceFrame::kBody}};
  model.outputs = {coordinateOutput("turn")};
  EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 0), 0.5 * 1.5 / 2.0, 1e-10);
}

TEST(Forces, TwoPointSpringConservesEnergy) {
  ModelSpec model = makeBlock("2", 5.0);
  model.system.elements.get<TwoPointSpring>() = {
      {station("ground", ex3("0", "0.3", "0.1")), station("block", kOrigin), ex("40"), ex("0.25")}};
  start(model, "x", "0.6");
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::LinSpaced(101, 0.0, 5.0));
  for (int i = 0; i < result.rows(); ++i) {
    const double length = std::sqrt(result(i, 0) * result(i, 0) + 0.1);
    const double energy = result(i, 1) * result(i, 1) + 20.0 * (length - 0.25) * (length - 0.25);
    EXPECT_NEAR(energy, 20.0 * std::pow(std::sqrt(0.46) - 0.25, 2), 1e-8);
  }
}

TEST(Forces, TwoPointDamperSlowsDown) {
  ModelSpec model = makeBlock("2", 1.0);
  model.system.elements.get<TwoPointDamper>() = {
      {station("ground", ex3("-1", "0", "0")), station("block", kOrigin), ex("3")}};
  start(model, "x", "0", "0.8");
  EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 1), 0.8 * std::exp(-1.5), 1e-9);
}

TEST(Forces, CoincidentPointsExertNoForce) {
  ModelSpec model = makeBlock("2", 1.0);
  model.system.elements.get<TwoPointSpring>() = {
      {station("ground", kOrigin), station("block", kOrigin), ex("3"), ex("0")}};
  model.system.elements.get<TwoPointDamper>() = {
      {station("ground", kOrigin), station("block", kOrigin), ex("3")}};
  EXPECT_EQ(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 0), 0.0);
}

TEST(Forces, BushingOnAFreeBodyActsAsSpringsAlongItsAxes) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("mass", "2", kOrigin, ex3("0.5", "0.5", "0.5"),
                              joint(JointType::kFree, {"a", "b", "c", "x", "y", "z"}))};
  Bushing<Expression> bushing;
  bushing.from.body = name("ground");
  bushing.to.body = name("mass");
  bushing.stiffness = {ex("4.5"), ex("0"), ex("0"), ex("18"), ex("0"), ex("8")};
  bushing.damping.fill(ex("0"));
  model.system.elements.get<Bushing>() = {bushing};
  start(model, "a", "0.3");
  start(model, "x", "1");
  start(model, "z", "1");
  model.outputs = {coordinateOutput("a"), coordinateOutput("x"), coordinateOutput("z")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_NEAR(result(0, 0), 0.3 * std::cos(3.0), 1e-9);
  EXPECT_NEAR(result(0, 1), std::cos(3.0), 1e-9);
  EXPECT_NEAR(result(0, 2), std::cos(2.0), 1e-9);
}

TEST(Outputs, StationsOfATurningBodyMoveOnACircle) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("disc", "4", kOrigin, ex3("1", "1", "2"), joint(JointType::kPin, {"turn"}))};
  start(model, "turn", "0", "3");
  const StationOutputSpec x =
      along("disc", ex3("0.5", "0", "0"), ex3("2", "0", "0"));  // direction is normalised
  model.outputs.resize(3);
  model.outputs[0].position = x;
  model.outputs[1].velocity = x;
  model.outputs[2].acceleration = x;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(11, 0.0, 1.0);
  const Eigen::MatrixXd result = runModel(model, times);
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(result(i, 0), 0.5 * std::cos(3.0 * times[i]), 1e-9);
    EXPECT_NEAR(result(i, 1), -1.5 * std::sin(3.0 * times[i]), 1e-9);
    EXPECT_NEAR(result(i, 2), -4.5 * std::cos(3.0 * times[i]), 1e-9);
  }
}

TEST(Outputs, AccelerationAtAnEventIsThatOfThePhaseThatBegins) {
  ModelSpec model = makeBlock("2", 2.0);
  model.excitation = {pulse("F", "3", "0.5", "1")};
  model.system.elements.get<ForceLaw>() = {law("x", "F")};
  model.outputs.resize(1);
  model.outputs[0] = {};
  model.outputs[0].acceleration = along("block", kOrigin, ex3("1", "0", "0"));
  Eigen::VectorXd times(5);
  times << 0.25, 0.5, 0.75, 1.0, 2.0;
  const Eigen::MatrixXd result = runModel(model, times);
  const double expected[] = {0.0, 1.5, 1.5, 0.0, 0.0};
  for (int i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(result(i, 0), expected[i]);
  }
}

TEST(Outputs, HaveUnits) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {
      body("rod", "2", kOrigin, ex3("1", "1", "1"), joint(JointType::kCylinder, {"turn", "slide"}))};
  model.outputs = {coordinateOutput("turn"), coordinateOutput("slide"), speedOutput("turn"),
                   speedOutput("slide")};
  model.outputs.resize(7);
  const StationOutputSpec at = along("rod", kOrigin, ex3("1", "0", "0"));
  model.outputs[4].position = at;
  model.outputs[5].velocity = at;
  model.outputs[6].acceleration = at;
  const MultibodySimulator simulator(model, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_EQ(simulator.getLayout().output_units,
            (std::vector<std::string>{"rad", "m", "rad/s", "m/s", "m", "m/s", "m/s2"}));
}

TEST(Outputs, SpeedOfABallJointIsTheDerivativeOfItsAngle) {
  ModelSpec model = makeModel(0.2);
  model.system.bodies = {
      body("top", "1", kOrigin, ex3("0.02", "0.03", "0.04"), joint(JointType::kBall, {"a", "b", "c"}))};
  start(model, "a", "0.2", "1");
  start(model, "b", "0.5", "2");
  start(model, "c", "-0.3", "3");
  model.outputs = {coordinateOutput("a"), coordinateOutput("b"), coordinateOutput("c"),
                   speedOutput("a"),      speedOutput("b"),      speedOutput("c")};
  Eigen::VectorXd times(3);
  times << 0.1 - 1e-4, 0.1, 0.1 + 1e-4;
  const Eigen::MatrixXd result = runModel(model, times);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(result(1, 3 + i), (result(2, i) - result(0, i)) / 2e-4, 1e-5);
  }
}

}  // namespace
}  // namespace twinmap::testing
