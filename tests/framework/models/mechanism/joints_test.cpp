// Every joint type against a closed form or a conserved quantity of its motion.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

constexpr double kGravity = 9.81;

TEST(Joints, SliderCarriesADampedOscillator) {
  ModelSpec model = makeModel(3.0);
  model.system.bodies = {
      body("mass", "2", kOrigin, kOrigin, joint(JointType::kSlider, ex3("1", "2", "-2"), {"x"}))};
  model.system.elements.get<Spring>() = {{name("x"), ex("50"), ex("0.1")}};
  model.system.elements.get<Damper>() = {{name("x"), ex("4")}};
  start(model, "x", "0.3");
  StationOutputSpec z = along("mass", kOrigin, ex3("0", "0", "1"));
  model.outputs = {coordinateOutput("x"), speedOutput("x")};
  model.outputs.emplace_back();
  model.outputs.back().position = z;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(31, 0.0, 3.0);
  const Eigen::MatrixXd result = runModel(model, times);
  const double decay = 1.0, omega = std::sqrt(25.0 - 1.0);
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double t = times[i], c = std::cos(omega * t), s = std::sin(omega * t);
    const double x = 0.1 + 0.2 * std::exp(-decay * t) * (c + decay / omega * s);
    const double speed = -0.2 * std::exp(-decay * t) * (omega + decay * decay / omega) * s;
    EXPECT_NEAR(result(i, 0), x, 1e-9);
    EXPECT_NEAR(result(i, 1), speed, 1e-8);
    EXPECT_NEAR(result(i, 2), -2.0 / 3.0 * x, 1e-9);
  }
}

TEST(Joints, PinSwingsAsAPhysicalPendulum) {
  // amplitude 1 rad: quarter period K(sin(1/2)) / omega0 with omega0^2 = m g l / (I + m l^2)
  ModelSpec model = makeModel(3.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {
      body("bob", "1.5", ex3("0", "-0.4", "0"), ex3("0.1", "0.1", "0.1"), joint(JointType::kPin, {"angle"}))};
  start(model, "angle", "1");
  model.outputs = {coordinateOutput("angle")};
  const double omega = std::sqrt(1.5 * kGravity * 0.4 / (0.1 + 1.5 * 0.16));
  const double quarter = std::comp_ellint_1(std::sin(0.5)) / omega;
  Eigen::VectorXd times(3);
  times << quarter, 2.0 * quarter, 4.0 * quarter;
  const Eigen::MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 0), 0.0, 1e-8);
  EXPECT_NEAR(result(1, 0), -1.0, 1e-8);
  EXPECT_NEAR(result(2, 0), 1.0, 1e-8);
}

TEST(Joints, WeldAddsItsMassToItsParent) {
  ModelSpec model = makeModel(2.0);
  model.system.bodies = {
      body("cart", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})),
      body("load", "3", ex3("0", "0.2", "0"), ex3("1", "1", "1"), joint(JointType::kWeld, {}, "cart"))};
  model.system.elements.get<Spring>() = {{name("x"), ex("36"), ex("0")}};
  start(model, "x", "0.1");
  model.outputs = {coordinateOutput("x")};
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(21, 0.0, 2.0);
  const Eigen::MatrixXd result = runModel(model, times);
  EXPECT_LT((result.col(0) - Eigen::VectorXd(0.1 * (3.0 * times).array().cos())).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Joints, ScrewTurnsUnderItsWeight) {
  // q'' = -m g p / (I + m p^2)
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "0", "-9.81");
  model.system.bodies = {body("nut", "2", kOrigin, ex3("0.01", "0.01", "0.01"),
                              joint(JointType::kScrew, ex3("0", "0", "1"), {"turn"}))};
  model.system.bodies[0].joint.pitch = ex("0.05");
  model.outputs = {coordinateOutput("turn")};
  const double acceleration = -2.0 * kGravity * 0.05 / (0.01 + 2.0 * 0.0025);
  EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 0), 0.5 * acceleration, 1e-8);
}

TEST(Joints, CylinderTurnsAndFallsIndependently) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("-9.81", "0", "0");
  model.system.bodies = {body("rod", "2", kOrigin, ex3("0.01", "0.02", "0.02"),
                              joint(JointType::kCylinder, ex3("1", "0", "0"), {"turn", "slide"}))};
  model.system.elements.get<Spring>() = {{name("turn"), ex("0.09"), ex("0")}};
  start(model, "turn", "0.5");
  start(model, "slide", "1", "2");
  model.outputs = {coordinateOutput("turn"), coordinateOutput("slide")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 0.7));
  EXPECT_NEAR(result(0, 0), 0.5 * std::cos(3.0 * 0.7), 1e-9);
  EXPECT_NEAR(result(0, 1), 1.0 + 2.0 * 0.7 - 0.5 * kGravity * 0.49, 1e-9);
}

TEST(Joints, BendStretchMovesAFreeParticleOnAStraightLine) {
  ModelSpec model = makeModel(2.0);
  model.system.bodies = {
      body("particle", "0.7", kOrigin, kOrigin, joint(JointType::kBendStretch, {"bend", "r"}))};
  start(model, "bend", "0", "0.5");  // at x = 2 with speed 1 along y
  start(model, "r", "2");
  model.outputs = {coordinateOutput("bend"), coordinateOutput("r")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_NEAR(result(0, 0), std::atan2(2.0, 2.0), 1e-9);
  EXPECT_NEAR(result(0, 1), std::hypot(2.0, 2.0), 1e-9);
}

TEST(Joints, PlanarBodyFliesAParabolaWhileItSpins) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {
      body("plate", "2", kOrigin, ex3("1", "1", "2"), joint(JointType::kPlanar, {"turn", "x", "y"}))};
  start(model, "turn", "0.1", "3");
  start(model, "x", "1", "2");
  start(model, "y", "0", "4");
  model.outputs = {coordinateOutput("turn"), coordinateOutput("x"), coordinateOutput("y")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_NEAR(result(0, 0), 3.1, 1e-9);
  EXPECT_NEAR(result(0, 1), 3.0, 1e-9);
  EXPECT_NEAR(result(0, 2), 4.0 - 0.5 * kGravity, 1e-9);
}

TEST(Joints, TranslationMovesAlongEachAxis) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {
      body("mass", "2", kOrigin, kOrigin, joint(JointType::kTranslation, {"x", "y", "z"}))};
  model.system.elements.get<Spring>() = {
      {name("x"), ex("8"), ex("0")}, {name("y"), ex("18"), ex("0")}, {name("z"), ex("32"), ex("0")}};
  start(model, "x", "1");
  start(model, "y", "1");
  start(model, "z", "1");
  model.outputs = {coordinateOutput("x"), coordinateOutput("y"), coordinateOutput("z")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 1.0));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(result(0, i), std::cos(2.0 + i), 1e-9);
  }
}

TEST(Joints, UniversalConservesEnergyAndMomentum) {
  // w = (a' cos b, b', a' sin b) in the body: (Ix cos^2 b + Iz sin^2 b) a' is conserved, and so is the energy
  const double ix = 0.02, iy = 0.03, iz = 0.04;
  ModelSpec model = makeModel(4.0);
  model.system.bodies = {
      body("cross", "1", kOrigin, ex3("0.02", "0.03", "0.04"), joint(JointType::kUniversal, {"a", "b"}))};
  start(model, "a", "0", "2");
  start(model, "b", "0.3", "0.4");
  model.outputs = {coordinateOutput("b"), speedOutput("a"), speedOutput("b")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::LinSpaced(41, 0.0, 4.0));
  for (int i = 0; i < result.rows(); ++i) {
    const double about_x =
        ix * std::pow(std::cos(result(i, 0)), 2) + iz * std::pow(std::sin(result(i, 0)), 2);
    const double first = ix * std::pow(std::cos(0.3), 2) + iz * std::pow(std::sin(0.3), 2);
    EXPECT_NEAR(about_x * result(i, 1), first * 2.0, 1e-10);
    const double energy = about_x * result(i, 1) * result(i, 1) + iy * result(i, 2) * result(i, 2);
    EXPECT_NEAR(energy, first * 4.0 + iy * 0.16, 1e-10);
  }
  EXPECT_GT((result.col(1).array() - 2.0).abs().maxCoeff(), 0.01);  // not a trivial motion
}

/// A free symmetric top whose angular momentum points along z: its axis turns on a cone about z.
class SymmetricTop : public ::testing::TestWithParam<JointType> {};

TEST_P(SymmetricTop, PrecessesAboutItsAngularMomentum) {
  const double across = 0.02, along_axis = 0.03, momentum = 0.1, tilt = 0.4;
  const double precession = momentum / across;
  const double spin = momentum * std::cos(tilt) * (1.0 / along_axis - 1.0 / across);
  ModelSpec model = makeModel(2.0);
  std::vector<std::string> coordinates{"a", "b", "c"};
  const bool moves = getCoordinateCount(GetParam()) == 6;
  if (moves) {
    coordinates.insert(coordinates.end(), {"x", "y", "z"});
  }
  model.system.bodies = {
      body("top", "1.2", kOrigin, ex3("0.02", "0.02", "0.03"), joint(GetParam(), coordinates))};
  start(model, "a", std::to_string(tilt));
  start(model, "b", "0", "5 * sin(0.4)");
  start(model, "c", "0", "5 * cos(0.4) + (" + std::to_string(spin) + ")");
  model.outputs.resize(2);
  model.outputs[0].position = along("top", ex3("0", "0", "1"), ex3("1", "0", "0"));
  model.outputs[1].position = along("top", ex3("0", "0", "1"), ex3("0", "1", "0"));
  double drift = 0.0;
  if (moves) {
    start(model, "x", "0", "0.25");
    drift = 0.25;
  }
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(21, 0.0, 2.0);
  const Eigen::MatrixXd result = runModel(model, times);
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double angle = precession * times[i];
    EXPECT_NEAR(result(i, 0), std::sin(tilt) * std::sin(angle) + drift * times[i], 1e-6);
    EXPECT_NEAR(result(i, 1), -std::sin(tilt) * std::cos(angle), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(RotatingJoints, SymmetricTop,
                         ::testing::Values(JointType::kGimbal, JointType::kBall, JointType::kBushing,
                                           JointType::kFree));

TEST(Joints, FramesPlaceTheJointOnBothBodies) {
  // a pin about the ground's y axis at (1, 0, 0); the body hangs 0.5 m from it along its own x
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("arm", "1", kOrigin, ex3("0.1", "0.1", "0.1"),
                              joint(JointType::kPin, ex3("0", "1", "0"), {"angle"}))};
  model.system.bodies[0].joint.in_parent.point = ex3("1", "0", "0");
  model.system.bodies[0].joint.in_body.point = ex3("-0.5", "0", "0");
  start(model, "angle", "pi / 2");
  model.outputs.resize(3);
  for (int i = 0; i < 3; ++i) {
    model.outputs[i].position =
        along("arm", kOrigin, ex3(i == 0 ? "1" : "0", i == 1 ? "1" : "0", i == 2 ? "1" : "0"));
  }
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 0.0));
  EXPECT_NEAR(result(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(result(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(result(0, 2), -0.5, 1e-12);
}

TEST(Joints, FrameOrientationTurnsTheAxis) {
  // a slider along x of a joint frame that is turned by 90 degrees about z moves along y
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("mass", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"s"}))};
  model.system.bodies[0].joint.in_parent.orientation = ex3("0", "0", "pi / 2");
  start(model, "s", "0.7");
  model.outputs.resize(1);
  model.outputs[0].position = along("mass", kOrigin, ex3("0", "3", "0"));
  EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 0.0))(0, 0), 0.7, 1e-12);
}

}  // namespace
}  // namespace twinmap::testing
