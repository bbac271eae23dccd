#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

/// (y, theta) at t = 0 of the two-beam case.
Eigen::Vector2d getStart(const ModelSpec& model, const Eigen::VectorXd& parameters) {
  return runModel(model, Eigen::VectorXd::Constant(1, 0.0), parameters).transpose();
}

TEST(Equilibrium, OfTheTwoBeamBoxCenterStartsEverySample) {
  const Eigen::Vector2d expected = calcTwoBeamEquilibrium({1.0, 2e-4, 10.0, 0.036});
  const Eigen::MatrixXd points = makeTwoBeamPoints(3);
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector2d start = getStart(makeTwoBeam(), points.col(j));
    EXPECT_NEAR(start[0], expected[0], 1e-13);
    EXPECT_NEAR(start[1], expected[1], 1e-12);
  }
}

TEST(Equilibrium, MayReplaceValuesOfTheBoxCenter) {
  ModelSpec model = makeTwoBeam();
  model.initial.equilibrium->parameters = {value("k_theta", "0.04")};
  const Eigen::Vector2d expected = calcTwoBeamEquilibrium({1.0, 2e-4, 10.0, 0.04});
  EXPECT_NEAR(getStart(model, makeTwoBeamPoints(1))[1], expected[1], 1e-12);
}

TEST(Equilibrium, MayBeEachSamplesOwn) {
  ModelSpec model = makeTwoBeam();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  const Eigen::Vector4d point = makeTwoBeamPoints(1).col(0);
  EXPECT_NEAR(getStart(model, point)[1], calcTwoBeamEquilibrium(point)[1], 1e-12);
}

TEST(Equilibrium, LeavesASampleAtRestWithoutExcitation) {
  ModelSpec model = makeTwoBeam();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  Eigen::VectorXd times(3);
  times << 0.0, 0.1, 0.2;
  const Eigen::MatrixXd result = runModel(model, times, makeTwoBeamPoints(1));
  EXPECT_NEAR(result(2, 1), result(0, 1), 1e-12);
  EXPECT_NEAR(result(2, 0), 0.0, 1e-12);
}

TEST(Equilibrium, IgnoresAnExcitationThatActsFromTheStart) {
  ModelSpec model = makeTwoBeam();
  model.excitation[0].pulses[0].start = ex("0");
  EXPECT_NEAR(getStart(model, makeTwoBeamPoints(1))[0], 0.0, 1e-13);
}

/// A pendulum with a weak torsion spring: k q = m g l cos q with several turns of q.
ModelSpec makeLever(const std::string& start_angle) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {
      body("lever", "1", ex3("0.5", "0", "0"), ex3("0.1", "0.1", "0.1"), joint(JointType::kPin, {"q"}))};
  model.system.elements.get<Spring>() = {{name("q"), ex("4"), ex("0")}};
  model.initial.coordinates = {value("q", start_angle)};
  model.initial.equilibrium = EquilibriumSpec{};
  model.outputs = {coordinateOutput("q")};
  return model;
}

TEST(Equilibrium, IsFoundFromAFarStart) {
  for (const char* start_angle : {"0", "1", "-3", "2.5"}) {
    const double q = runModel(makeLever(start_angle), Eigen::VectorXd::Constant(1, 0.0))(0, 0);
    EXPECT_NEAR(4.0 * q + 0.5 * 9.81 * std::cos(q), 0.0, 1e-10) << start_angle;
  }
}

TEST(Equilibrium, LeavesAFreeDirectionWhereItWas) {
  ModelSpec model = makeLever("0.2");
  model.system.bodies.insert(model.system.bodies.begin(),
                             body("cart", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})));
  model.system.bodies[1].joint.parent = name("cart");
  model.initial.coordinates.push_back(value("x", "0.7"));
  model.outputs = {coordinateOutput("x"), coordinateOutput("q")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 0.0));
  EXPECT_NEAR(4.0 * result(0, 1) + 0.5 * 9.81 * std::cos(result(0, 1)), 0.0, 1e-10);
  EXPECT_NEAR(result(0, 0), 0.7, 1e-12);
}

TEST(Equilibrium, OfASystemThatIsInBalanceIsItsStart) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("cart", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.initial.coordinates = {value("x", "0.7")};
  model.initial.equilibrium = EquilibriumSpec{};
  model.outputs = {coordinateOutput("x")};
  EXPECT_EQ(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 0), 0.7);
}

ModelSpec makeFallingBlock(EquilibriumAt at) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("9.81", "0", "0");
  model.system.bodies = {body("block", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.initial.equilibrium = EquilibriumSpec{};
  model.initial.equilibrium->at = at;
  model.outputs = {coordinateOutput("x")};
  return model;
}

TEST(Equilibrium, ThatDoesNotExistIsAFailureWithItsResidual) {
  EXPECT_EQ(getReason(makeFallingBlock(EquilibriumAt::kSample)),
            "static equilibrium not found: largest acceleration, or rate of a state, left 9.81 (SI units)");
}

TEST(Equilibrium, ThatDoesNotExistAtTheBoxCenterIsWrongInput) {
  EXPECT_NE(getError(makeFallingBlock(EquilibriumAt::kBoxCenter)).find("static equilibrium not found"),
            std::string::npos);
}

}  // namespace
}  // namespace twinmap::testing
