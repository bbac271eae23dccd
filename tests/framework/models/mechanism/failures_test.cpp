// What cannot be simulated, and what is wrong input.

#include <limits>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

/// A mass m on a spring k with damping c, all parameters; starts at x = 1.
ModelSpec makeOscillator() {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("m", 0.5, 1.5), parameter("k", 5.0, 15.0), parameter("c", 0.0, 1.0)};
  model.system.bodies = {body("block", "m", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.system.elements.get<Spring>() = {{name("x"), ex("k"), ex("0")}};
  model.system.elements.get<Damper>() = {{name("x"), ex("c")}};
  start(model, "x", "1");
  model.outputs = {coordinateOutput("x")};
  return model;
}

TEST(Failures, NameBodyQuantityValueAndRule) {
  EXPECT_EQ(getReason(makeOscillator(), Eigen::Vector3d(0.0, 10.0, 0.0)),
            "body 'block': mass = 0 kg must be positive");
  EXPECT_EQ(getReason(makeOscillator(), Eigen::Vector3d(-2.5, 10.0, 0.0)),
            "body 'block': mass = -2.5 kg must be positive");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(getReason(makeOscillator(), Eigen::Vector3d(1.0, nan, 0.0)), "parameter: k = nan must be finite");
}

TEST(Failures, AreThoseOfNumbersThatFollowParameters) {
  ModelSpec model = makeOscillator();
  model.constants = {constant("fixed", "1.2"), constant("rest", "m - fixed"), constant("soft", "1 / c")};
  model.system.bodies[0].mass = ex("rest");
  model.system.elements.get<Spring>() = {{name("x"), ex("fixed / (k - 12)"), ex("0")}};
  model.parameters[0].bounds = {1.5, 2.5, {}};
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.5)),
            "body 'block': mass = -0.2 kg must be positive");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(2.0, 12.0, 0.5)),
            "spring on 'x': stiffness = inf must be finite");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(2.0, 11.0, 0.0)), "constant: soft = inf must be finite");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(2.0, 13.0, 0.5)), "");
}

TEST(Failures, StepLimitNamesItsTime) {
  ModelSpec model = makeOscillator();
  model.simulation.max_steps = 20;
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.1)).rfind("step limit of 20 reached at t = ", 0),
            0u);
}

TEST(Failures, WallTimeLimitNamesItsTime) {
  ModelSpec model = makeOscillator();
  model.simulation.max_wall_time = 1e-9;
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.1)),
            "wall-time limit of 1e-09 s reached at t = 0 s");
}

TEST(Failures, OnlyTheWallTimeLimitDependsOnTheMachine) {
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    ModelSpec model = makeOscillator();
    model.simulation.engine = engine;
    model.simulation.max_steps = 20;
    EXPECT_FALSE(getStatus(model, Eigen::Vector3d(1.0, 1e4, 0.1)).machine_dependent);
    model.simulation.max_steps = 100000;
    model.simulation.max_wall_time = 1e-9;
    EXPECT_TRUE(getStatus(model, Eigen::Vector3d(1.0, 1e4, 0.1)).machine_dependent);
  }
}

TEST(Failures, InstabilityIsReportedWithItsTime) {
  ModelSpec model = makeOscillator();
  model.system.elements.get<ForceLaw>() = {law("x", "100 * x^3")};  // x reaches infinity in finite time
  const std::string reason = getReason(model, Eigen::Vector3d(1.0, 10.0, 0.1));
  EXPECT_NE(reason.find(" at t = 0."), std::string::npos) << reason;
}

TEST(Failures, BlowUpOfARotationIsReportedAsSuch) {
  ModelSpec model = makeModel(2.0);
  model.system.bodies = {
      body("arm", "1", ex3("0.1", "0.2", "0"), ex3("1", "1", "1"), joint(JointType::kPin, {"turn"})),
      body("tip", "1", ex3("0.1", "0", "0.3"), ex3("1", "1", "1"),
           joint(JointType::kUniversal, {"a", "b"}, "arm"))};
  model.system.elements.get<ForceLaw>() = {law("turn", "exp(turn)")};
  start(model, "turn", "5");
  model.outputs = {coordinateOutput("turn")};
  const std::string reason = getReason(model);
  EXPECT_EQ(reason.find("singular"), std::string::npos) << reason;
  EXPECT_NE(reason.find(" at t = 0."), std::string::npos) << reason;
}

TEST(Failures, ForceThatBecomesNonFiniteIsReported) {
  ModelSpec model = makeOscillator();
  model.system.elements.get<ForceLaw>() = {law("x", "sqrt(0.5 - t)")};
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.1)), "state became non-finite at t = 0.5 s");
}

const std::string kTooLargeMoment =
    "must not exceed the sum of the other two (of a body that turns about one axis alone, only the moment J "
    "about that axis acts: write [J, J, J])";

TEST(Failures, InertiaMustBeThatOfARealBody) {
  ModelSpec model = makeOscillator();
  model.system.bodies[0].inertia.moments = ex3("c", "1", "1");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 3.0)),
            "body 'block': inertia: largest principal moment = 3 kg m2 " + kTooLargeMoment);
  model.system.bodies[0].inertia.moments = ex3("1", "1", "1.5");
  model.system.bodies[0].inertia.products = ex3("c - 0.5", "0", "0");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 1.7)),
            "body 'block': inertia: smallest principal moment = -0.2 kg m2 must not be negative");
}

TEST(Failures, MassAndPlaceMustNotExceedTheRangeOfNumbers) {
  ModelSpec model = makeOscillator();
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1e-320, 10.0, 0.0)),
            "body 'block': mass = 9.99988867e-321 kg is too small: its inverse must be finite");
  model.system.bodies[0].center_of_mass = ex3("0", "0", "c");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 1e200)),
            "body 'block': center_of_mass = 1e+200 m is too far away: the inertia about the body's origin "
            "must be finite");
}

TEST(Failures, RotationWithoutInertiaIsSingular) {
  ModelSpec model = makeOscillator();
  model.system.bodies.push_back(
      body("pointer", "1", ex3("0", "c", "0"), kOrigin, joint(JointType::kPin, {"turn"}, "block")));
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.0)),
            "the mass matrix is singular: a body without inertia can move freely");
  EXPECT_EQ(getReason(model, Eigen::Vector3d(1.0, 10.0, 0.5)), "");
}

TEST(Failures, NeverShiftOtherSamples) {
  Eigen::MatrixXd points(3, 7);
  for (int j = 0; j < 7; ++j) {
    points.col(j) << 1.0 + 0.1 * j, 10.0 + j, 0.1;
  }
  const MultibodySimulator simulator(makeOscillator(), Eigen::VectorXd::LinSpaced(5, 0.0, 2.0));
  const Trajectories whole = generateSamples(simulator, points);
  ASSERT_EQ(whole.calcFailureCount(), 0);
  points(0, 2) = 0.0;
  points(0, 5) = -1.0;
  for (const int threads : {1, 3}) {
    for (const int batch : {1, 4}) {
      const Trajectories result = generateSamples(simulator, points, {threads, batch, {}});
      EXPECT_EQ(result.calcFailureCount(), 2);
      for (int j = 0; j < 7; ++j) {
        const bool failed = j == 2 || j == 5;
        EXPECT_EQ(result.statuses[j].ok, !failed);
        EXPECT_TRUE(failed ? result.responses.col(j).array().isNaN().all()
                           : result.responses.col(j) == whole.responses.col(j));
      }
    }
  }
}

TEST(WrongInput, NamesWhatIsUnknownAndWhatIsNear) {
  ModelSpec model = makeOscillator();
  model.system.elements.get<Spring>()[0].coordinate = name("y");
  EXPECT_NE(getError(model).find("'y' is not a coordinate"), std::string::npos);
  model = makeOscillator();
  model.system.elements.get<Spring>()[0].stiffness = ex("kk * 2");
  EXPECT_NE(getError(model).find("unknown name 'kk'; did you mean 'k'?"), std::string::npos);
  model = makeOscillator();
  model.system.bodies[0].joint.parent = name("grund");
  EXPECT_NE(getError(model).find("did you mean 'ground'?"), std::string::npos);
  model = makeOscillator();
  model.outputs[0].coordinate = name("z");
  EXPECT_NE(getError(model).find("'z' is not a coordinate"), std::string::npos);
  model = makeOscillator();
  model.initial.coordinates[0].name = name("z");
  EXPECT_NE(getError(model).find("'z' is not a coordinate"), std::string::npos);
  model = makeOscillator();
  model.initial.equilibrium = EquilibriumSpec{};
  model.initial.equilibrium->parameters = {value("n", "1")};
  EXPECT_NE(getError(model).find("'n' is not a parameter"), std::string::npos);
}

TEST(WrongInput, NumbersOfASystemMayNotUseItsMotion) {
  ModelSpec model = makeOscillator();
  model.system.elements.get<Spring>()[0].stiffness = ex("k * x");
  EXPECT_NE(getError(model).find("unknown name 'x'"), std::string::npos);
}

TEST(WrongInput, ForcesOnTheAnglesOfABallAreRefusedWithAdvice) {
  for (const JointType type : {JointType::kBall, JointType::kFree}) {
    ModelSpec model = makeModel(1.0);
    const std::vector<std::string> names{"a", "b", "c", "x", "y", "z"};
    const std::vector<std::string> own(names.begin(), names.begin() + (type == JointType::kBall ? 3 : 6));
    model.system.bodies = {body("top", "1", kOrigin, ex3("1", "1", "1"), joint(type, own))};
    model.outputs = {coordinateOutput("a")};
    ModelSpec spring = model, damper = model, force_law = model;
    spring.system.elements.get<Spring>() = {{name("b"), ex("1"), ex("0")}};
    damper.system.elements.get<Damper>() = {{name("c"), ex("1")}};
    force_law.system.elements.get<ForceLaw>() = {law("a", "1")};
    for (const ModelSpec& wrong : {spring, damper, force_law}) {
      EXPECT_NE(getError(wrong).find("use a bushing or an applied moment"), std::string::npos)
          << getError(wrong);
    }
    if (type == JointType::kFree) {
      model.system.elements.get<Spring>() = {{name("x"), ex("1"), ex("0")}};
      EXPECT_EQ(getError(model), "");
    }
  }
}

TEST(WrongInput, NamesAreUniqueAndCountsMatch) {
  ModelSpec model = makeOscillator();
  model.system.bodies[0].joint.coordinates = {name("x"), name("y")};
  EXPECT_NE(getError(model).find("needs 1 coordinate names"), std::string::npos);
  model = makeOscillator();
  model.constants = {constant("k", "1")};
  EXPECT_NE(getError(model).find("'k' is the name of something else already"), std::string::npos);
  model = makeOscillator();
  model.system.bodies.push_back(model.system.bodies[0]);
  EXPECT_NE(getError(model).find("is declared twice"), std::string::npos);
  model = makeOscillator();
  model.outputs[0].speed = name("x");
  EXPECT_NE(getError(model).find("must measure one of"), std::string::npos);
}

TEST(WrongInput, SystemThatCannotExistAtTheBoxCenterIsRefused) {
  ModelSpec model = makeOscillator();
  model.parameters[0] = parameter("m", -2.0, 1.0);
  EXPECT_EQ(getError(model), "at the centre of the bounds: body 'block': mass = -0.5 kg must be positive");
}

/// As read from a file.
SourceLocation at(int line, const std::string& key) {
  return {"cart.yaml", line, 12, key};
}

TEST(WrongInput, WhatCannotExistAtTheBoxCenterIsNamedWithItsPlace) {
  const std::string centre = ": at the centre of the bounds: ";
  ModelSpec model = makeOscillator();
  model.system.bodies[0].name.where = at(5, "system.bodies.block");
  model.system.bodies[0].mass = {"-m", at(6, "system.bodies.block.mass")};
  EXPECT_EQ(getError(model), "cart.yaml:6:12: system.bodies.block.mass" + centre +
                                 "body 'block': mass = -1 kg must be positive");
  model.system.bodies[0].mass = {"m", {}};
  model.system.bodies[0].inertia.moments = {Expression{"3", at(7, "system.bodies.block.inertia")},
                                            Expression{"1", {}}, Expression{"1", {}}};
  EXPECT_EQ(getError(model), "cart.yaml:7:12: system.bodies.block.inertia" + centre +
                                 "body 'block': inertia: largest principal moment = 3 kg m2 " +
                                 kTooLargeMoment);
  model.system.bodies[0].inertia.moments = kOrigin;
  model.constants = {{name("n"), {"1 / (m - 1)", at(3, "constants.n")}, "", "", {}}};
  EXPECT_EQ(getError(model), "cart.yaml:3:12: constants.n" + centre + "constant: n = inf must be finite");
}

/// What checkStart() says against a model, or "".
std::string getStartError(const ModelSpec& model) {
  try {
    MultibodySimulator(model, Eigen::VectorXd::Constant(1, model.simulation.duration)).checkStart();
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(WrongInput, AnInitialStateThatFailsAtTheBoxCenterIsRefused) {
  const std::string centre = "cart.yaml:5:12: system: at the centre of the bounds: ";
  ModelSpec model = makeOscillator();
  EXPECT_EQ(getStartError(model), "");
  model.system.bodies[0].name.where = at(5, "system.bodies.block");
  model.system.elements.get<ForceLaw>() = {law("x", "sqrt(x - 2)")};  // x = 1
  EXPECT_EQ(getStartError(model), centre + "the accelerations of the initial state are not finite");
  model.system.elements.get<ForceLaw>() = {
      law("x", "-50 - k * x^2")};  // none: 10 x + 10 x^2 + 50 has no root
  for (const EquilibriumAt place : {EquilibriumAt::kBoxCenter, EquilibriumAt::kSample}) {
    model.initial.equilibrium = EquilibriumSpec{place, {}};
    EXPECT_EQ(getStartError(model).rfind(centre + "static equilibrium not found", 0), 0u)
        << getStartError(model);
  }
  model = makeOscillator();
  model.system.bodies.push_back(
      body("pointer", "1", kOrigin, kOrigin, joint(JointType::kPin, {"turn"}, "block")));
  EXPECT_EQ(getStartError(model),
            "at the centre of the bounds: the mass matrix is singular: a body without "
            "inertia can move freely");
}

TEST(WrongInput, MatricesOfTheWrongShapeAreRefused) {
  MultibodySimulator simulator(makeOscillator(), Eigen::Vector2d(0.5, 1.0));
  Eigen::MatrixXd good(2, 1), bad(3, 1);
  SampleStatus status;
  EXPECT_THROW(simulator.simulate(Eigen::MatrixXd::Ones(2, 1), good, &status), std::invalid_argument);
  EXPECT_THROW(simulator.simulate(Eigen::MatrixXd::Ones(3, 1), bad, &status), std::invalid_argument);
  EXPECT_NO_THROW(simulator.simulate(Eigen::MatrixXd::Ones(3, 1), good, &status));
}

TEST(WrongInput, TimesMustIncreaseWithinTheDuration) {
  const ModelSpec model = makeOscillator();
  EXPECT_THROW(MultibodySimulator(model, Eigen::Vector2d(0.5, 0.5)), ExperimentError);
  EXPECT_THROW(MultibodySimulator(model, Eigen::Vector2d(-0.1, 0.5)), ExperimentError);
  EXPECT_THROW(MultibodySimulator(model, Eigen::Vector2d(0.1, 2.5)), ExperimentError);
}

}  // namespace
}  // namespace twinmap::testing
