// Closed loops, rods and gears: against minimal coordinates by scipy, closed forms, finite differences and
// Simbody's own constraints.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/models/mechanism/loop_golden.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const VectorXd kLoopTimes = Eigen::Map<const VectorXd>(golden::kLoopTimes, 8);

ConstraintSpec coincident(const std::string& from, const Expression3& from_point, const std::string& to,
                          const Expression3& to_point) {
  ConstraintSpec spec;
  spec.coincident = CoincidentSpec{station(from, from_point), station(to, to_point)};
  return spec;
}

ConstraintSpec rod(const std::string& from, const Expression3& from_point, const std::string& to,
                   const Expression3& to_point, const std::string& length) {
  ConstraintSpec spec;
  spec.rod = RodSpec{station(from, from_point), station(to, to_point), ex(length)};
  return spec;
}

ConstraintSpec gear(const std::string& coordinate, const std::string& driver, const std::string& ratio,
                    const std::string& offset = "0") {
  ConstraintSpec spec;
  spec.gear = GearSpec{name(coordinate), name(driver), ex(ratio), ex(offset)};
  return spec;
}

/// A bar that turns about z at `at` of its parent.
BodySpec bar(const std::string& text, const std::string& mass, const Expression3& center,
             const std::string& inertia, const std::string& coordinate, const std::string& parent,
             const Expression3& at) {
  JointSpec pin = joint(JointType::kPin, {coordinate}, parent);
  pin.in_parent.point = at;
  pin.in_parent.orientation = kOrigin;
  pin.in_body = {kOrigin, kOrigin};
  return body(text, mass, center, ex3("0", inertia, inertia), pin);
}

/// make_loop_golden.py: list_four_bar, on a body or on ground.
void addFourBar(ModelSpec& model, const std::string& base = "ground") {
  model.system.bodies.push_back(bar("crank", "0.2", ex3("0.05", "0", "0"), "1e-4", "a", base, kOrigin));
  model.system.bodies.push_back(
      bar("coupler", "0.3", ex3("0.15", "0", "0"), "2e-3", "b", "crank", ex3("0.1", "0", "0")));
  model.system.bodies.push_back(
      bar("rocker", "0.25", ex3("0.1", "0.01", "0"), "1e-3", "c", base, ex3("0.25", "0", "0")));
  model.system.constraints.push_back(
      coincident("coupler", ex3("0.3", "0", "0"), "rocker", ex3("0.2", "0", "0")));
}

OutputSpec positionOutput(const std::string& text, const std::string& of, const Expression3& point,
                          const Expression3& direction) {
  OutputSpec spec;
  spec.name = name(text);
  spec.position = along(of, point, direction);
  return spec;
}

/// make_loop_golden.py: four_bar.
ModelSpec makeFourBar() {
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  addFourBar(model);
  model.system.elements.get<Damper>().push_back({name("a"), ex("2e-3")});
  start(model, "a", "1", "3");
  model.initial.coordinates.push_back(value("b", "-0.677"));
  model.initial.coordinates.push_back(value("c", "1.112"));
  model.outputs = {coordinateOutput("a"), coordinateOutput("b"), coordinateOutput("c")};
  return model;
}

/// make_loop_golden.py: slider_crank.
ModelSpec makeSliderCrank() {
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies.push_back(bar("crank", "0.5", ex3("0.02", "0", "0"), "4e-4", "a", "ground", kOrigin));
  model.system.bodies.push_back(
      bar("rod", "0.4", ex3("0.1", "0", "0"), "2e-3", "b", "crank", ex3("0.08", "0", "0")));
  model.system.bodies.push_back(body("piston", "0.6", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})));
  model.system.constraints.push_back(coincident("rod", ex3("0.22", "0", "0"), "piston", kOrigin));
  model.system.elements.get<Spring>().push_back({name("x"), ex("150"), ex("0.2")});
  model.system.elements.get<Damper>().push_back({name("a"), ex("0.01")});
  model.system.elements.get<ForceLaw>().push_back(law("a", "0.6 * sin(7 * t)"));
  start(model, "a", "0.4", "8");
  model.initial.coordinates.push_back(value("b", "-0.5"));
  model.initial.coordinates.push_back(value("x", "0.3"));
  model.outputs = {coordinateOutput("a"), coordinateOutput("b"), coordinateOutput("x")};
  return model;
}

template <std::size_t rows>
void expectGolden(const MatrixXd& response, const double (&golden)[rows][8], double tolerance) {
  for (std::size_t i = 0; i < rows; ++i) {
    const VectorXd expected = Eigen::Map<const VectorXd>(golden[i], 8);
    const double range = expected.maxCoeff() - expected.minCoeff();
    EXPECT_LT((response.col(static_cast<Index>(i)) - expected).cwiseAbs().maxCoeff(), tolerance * range) << i;
  }
}

/// By lanes, and by Simbody at its own integrator's accuracy.
template <std::size_t rows>
void expectGoldenOfBoth(ModelSpec model, const double (&golden)[rows][8]) {
  model.simulation.engine = Engine::kLanes;
  expectGolden(runModel(model, kLoopTimes), golden, 1e-7);
  model.simulation.engine = Engine::kSimbody;
  model.simulation.relative_tolerance = 1e-8;
  expectGolden(runModel(model, kLoopTimes), golden, 1e-5);
}

TEST(Loops, OfAFourBarMoveAsInMinimalCoordinates) {
  expectGoldenOfBoth(makeFourBar(), golden::kFourBar);
}

TEST(Loops, OfASliderCrankMoveAsInMinimalCoordinates) {
  expectGoldenOfBoth(makeSliderCrank(), golden::kSliderCrank);
}

TEST(Loops, AreMetAtTheDefaultTolerancesOfIntegration) {
  ModelSpec model = makeFourBar();
  model.simulation = SimulationSpec();
  model.simulation.duration = 2.0;
  expectGolden(runModel(model, kLoopTimes), golden::kFourBar, 1e-4);
  model = makeSliderCrank();
  model.simulation = SimulationSpec();
  model.simulation.duration = 2.0;
  expectGolden(runModel(model, kLoopTimes), golden::kSliderCrank, 1e-4);
}

TEST(Loops, StayClosed) {
  for (const double tolerance : {1e-3, 3e-7}) {
    ModelSpec model = makeFourBar();
    model.simulation.relative_tolerance = tolerance;
    model.simulation.absolute_tolerance = 1e-2 * tolerance;
    model.outputs = {
        positionOutput("x1", "coupler", ex3("0.3", "0", "0"), ex3("1", "0", "0")),
        positionOutput("x2", "rocker", ex3("0.2", "0", "0"), ex3("1", "0", "0")),
        positionOutput("y1", "coupler", ex3("0.3", "0", "0"), ex3("0", "1", "0")),
        positionOutput("y2", "rocker", ex3("0.2", "0", "0"), ex3("0", "1", "0")),
    };
    const MatrixXd response = runModel(model, VectorXd::LinSpaced(201, 0.0, 2.0));
    EXPECT_LT((response.col(0) - response.col(1)).cwiseAbs().maxCoeff(), 1e-9 * 0.3) << tolerance;
    EXPECT_LT((response.col(2) - response.col(3)).cwiseAbs().maxCoeff(), 1e-9 * 0.3) << tolerance;
  }
}

TEST(Loops, OnATurningBaseAreSimbodys) {
  // the plane of the loop turns, so that which condition is redundant must be seen from a body of the loop
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies.push_back(body("base", "1", kOrigin, ex3("0.1", "0.1", "0.1"),
                                     joint(JointType::kPin, ex3("0", "1", "0"), {"turn"})));
  addFourBar(model, "base");
  start(model, "a", "1", "1");
  start(model, "turn", "0.2", "2");
  model.initial.coordinates.push_back(value("c", "1.1"));
  model.outputs = {coordinateOutput("a"), coordinateOutput("turn"), coordinateOutput("c")};
  model.simulation.engine = Engine::kLanes;
  const MatrixXd own = runModel(model, kLoopTimes);
  model.simulation.engine = Engine::kSimbody;
  model.simulation.relative_tolerance = 1e-8;
  EXPECT_LT((runModel(model, kLoopTimes) - own).cwiseAbs().maxCoeff(), 1e-5);
}

/// A ball on a rod: a spherical pendulum, of a body that could move freely.
TEST(Loops, OfARodMakeAPendulum) {
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "0", "-9.81");
  model.system.bodies.push_back(
      body("ball", "0.7", kOrigin, kOrigin, joint(JointType::kTranslation, {"x", "y", "z"})));
  model.system.constraints.push_back(rod("ground", kOrigin, "ball", kOrigin, "0.5"));
  model.initial.coordinates = {value("x", "0.3"), value("z", "-0.5")};
  model.outputs = {coordinateOutput("x"), coordinateOutput("y"), coordinateOutput("z")};
  const MatrixXd own = runModel(model, kLoopTimes);
  ModelSpec pendulum = makeModel(2.0);
  pendulum.system.gravity = model.system.gravity;
  pendulum.system.bodies.push_back(body("ball", "0.7", ex3("0", "0", "-0.5"), kOrigin,
                                        joint(JointType::kPin, ex3("0", "1", "0"), {"angle"})));
  pendulum.initial.coordinates = {value("angle", "-asin(0.6)")};  // x is held, z follows
  pendulum.outputs = {positionOutput("x", "ball", ex3("0", "0", "-0.5"), ex3("1", "0", "0")),
                      positionOutput("y", "ball", ex3("0", "0", "-0.5"), ex3("0", "1", "0")),
                      positionOutput("z", "ball", ex3("0", "0", "-0.5"), ex3("0", "0", "1"))};
  EXPECT_LT((own - runModel(pendulum, kLoopTimes)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Loops, OfGearsMoveAsOneInertia) {
  // J1 a'' + n J2 b'' = -k a with b = n a + offset; and a rack: x = r a
  ModelSpec model = makeModel(2.0);
  model.system.bodies.push_back(bar("motor", "1", kOrigin, "0.02", "a", "ground", kOrigin));
  model.system.bodies.push_back(bar("wheel", "1", kOrigin, "0.3", "b", "ground", kOrigin));
  model.system.bodies.push_back(body("rack", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})));
  model.system.constraints = {gear("b", "a", "-0.25", "0.5"), gear("x", "a", "0.04")};
  model.system.elements.get<Spring>().push_back({name("x"), ex("400"), ex("0")});
  start(model, "a", "0.3", "0");
  model.outputs = {coordinateOutput("a"), coordinateOutput("b"), coordinateOutput("x")};
  const MatrixXd response = runModel(model, kLoopTimes);
  const double omega = std::sqrt(400.0 * 0.04 * 0.04 / (0.02 + 0.25 * 0.25 * 0.3 + 0.04 * 0.04 * 2.0));
  for (Index i = 0; i < kLoopTimes.size(); ++i) {
    const double angle = 0.3 * std::cos(omega * kLoopTimes[i]);
    EXPECT_NEAR(response(i, 0), angle, 1e-8);
    EXPECT_NEAR(response(i, 1), 0.5 - 0.25 * angle, 1e-8);
    EXPECT_NEAR(response(i, 2), 0.04 * angle, 1e-9);
  }
}

TEST(Loops, OfAPointInAPlaneSlideDownIt) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "0", "-9.81");
  model.system.bodies.push_back(
      body("bead", "0.7", kOrigin, kOrigin, joint(JointType::kTranslation, {"x", "y", "z"})));
  ConstraintSpec plane;
  plane.point_in_plane = PointInPlaneSpec{
      station("bead", kOrigin), PlaneSpec{name("ground"), ex3("0", "0", "0.2"), ex3("3", "0", "4")}};
  model.system.constraints = {plane};
  model.initial.coordinates = {value("x", "0")};  // held; z follows
  model.outputs = {coordinateOutput("x"), coordinateOutput("z")};
  const MatrixXd response = runModel(model, VectorXd::Constant(1, 1.0));
  const double travel = 0.5 * 9.81 * 0.6;  // along the slope
  EXPECT_NEAR(response(0, 0), 0.8 * travel, 1e-8);
  EXPECT_NEAR(response(0, 1), 0.2 - 0.6 * travel, 1e-8);
}

/// The derivatives of a simulation against differences of its responses.
void expectExactLoopDerivatives(ModelSpec model, const VectorXd& point) {
  model.simulation.engine = Engine::kLanes;
  model.simulation.relative_tolerance = 1e-11;
  model.simulation.absolute_tolerance = 1e-13;
  MultibodySimulator simulator(model, kLoopTimes);
  const Index rows = kLoopTimes.size() * static_cast<Index>(model.outputs.size()), p = point.size();
  const VectorXd widths = calcWidths(collectSampled(model));
  MatrixXd response(rows, 1), derivatives, points(p, 2 * p), around(rows, 2 * p);
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, derivatives, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  const double step = 1e-4;
  for (Index k = 0; k < p; ++k) {
    points.col(2 * k) = points.col(2 * k + 1) = point;
    points(k, 2 * k) += step * widths[k];
    points(k, 2 * k + 1) -= step * widths[k];
  }
  std::vector<SampleStatus> statuses(2 * p);
  simulator.simulate(points, around, statuses.data());
  for (Index k = 0; k < p; ++k) {
    ASSERT_TRUE(statuses[2 * k].ok && statuses[2 * k + 1].ok) << statuses[2 * k].reason;
    const VectorXd difference = (around.col(2 * k) - around.col(2 * k + 1)) / (2.0 * step * widths[k]);
    const double largest = difference.cwiseAbs().maxCoeff();
    EXPECT_GT(largest, 0.0) << k;
    EXPECT_LT((derivatives.col(k) - difference).cwiseAbs().maxCoeff(), 1e-5 * largest) << k;
  }
  expectFirstHeld(model, kLoopTimes, 0, point, derivatives);
}

TEST(Loops, HaveExactDerivativesThroughAssemblyAndProjection) {
  ModelSpec model = makeFourBar();
  model.simulation.duration = 2.0;
  model.parameters = {parameter("l", 0.29, 0.31), parameter("m3", 0.2, 0.3), parameter("a0", 0.9, 1.1),
                      parameter("v0", 2, 4)};
  model.system.constraints[0].coincident->from.point = ex3("l", "0", "0");
  model.system.bodies[2].mass = ex("m3");
  model.initial.coordinates[0] = value("a", "a0");
  model.initial.speeds[0] = value("a", "v0");
  expectExactLoopDerivatives(model, Eigen::Vector4d(0.302, 0.26, 0.98, 2.5));
}

TEST(Loops, HaveExactDerivativesFromAnEquilibriumOn) {
  ModelSpec model = makeSliderCrank();
  model.parameters = {parameter("k", 140, 160), parameter("r", 0.07, 0.09)};
  model.system.elements.get<Spring>()[0].stiffness = ex("k");
  model.system.bodies[1].joint.in_parent.point = ex3("r", "0", "0");
  // a small drive: the piston swings about its equilibrium, where differences are near the derivatives
  model.system.elements.get<ForceLaw>()[0].force = ex("0.02 * sin(7 * t)");
  model.initial.speeds.clear();
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  expectExactLoopDerivatives(model, Eigen::Vector2d(152, 0.081));
  model.initial.equilibrium->at = EquilibriumAt::kBoxCenter;
  expectExactLoopDerivatives(model, Eigen::Vector2d(152, 0.081));
}

TEST(Loops, HaveExactDerivativesOnBalls) {
  // a ball joint's speeds are no derivatives of its angles
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "0", "-9.81");
  model.parameters = {parameter("l", 0.3, 0.4), parameter("q0", 0.1, 0.3)};
  model.system.bodies.push_back(body("arm", "0.7", ex3("0.2", "0", "0"), ex3("1e-3", "2e-3", "3e-3"),
                                     joint(JointType::kBall, {"q1", "q2", "q3"})));
  model.system.constraints = {rod("ground", ex3("0.3", "0.3", "0"), "arm", ex3("0.4", "0", "0"), "l")};
  model.system.elements.get<AppliedMoment>().push_back({name("arm"), ex3("0.01", "0", "0.02")});
  model.initial.coordinates = {value("q1", "q0"), value("q2", "0.1"), value("q3", "0.3")};
  model.initial.speeds = {value("q1", "1")};
  model.outputs = {coordinateOutput("q1"), coordinateOutput("q2"), coordinateOutput("q3"), speedOutput("q2")};
  expectExactLoopDerivatives(model, Eigen::Vector2d(0.33, 0.2));
}

/// A sine of so low a frequency that it does not change.
SineSpec steadySine(const std::string& amplitude) {
  SineSpec sine;
  sine.amplitude = ex(amplitude);
  sine.frequency = ex("1e-12");
  sine.phase = ex("pi / 2");
  return sine;
}

SignalSpec constantSignal(const std::string& text, const std::string& amplitude) {
  SignalSpec signal;
  signal.name = name(text);
  signal.sines = {steadySine(amplitude)};
  return signal;
}

/// The slider-crank with its crank's angle prescribed: 0.4 + swing sin(2 pi 1.3 t), from within its motion.
ModelSpec makeDrivenSliderCrank() {
  ModelSpec model = makeSliderCrank();
  model.parameters = {parameter("swing", 0.5, 0.7), parameter("l", 0.2, 0.24)};
  model.system.elements.get<ForceLaw>().clear();
  model.system.constraints[0].coincident->from.point = ex3("l", "0", "0");
  SignalSpec drive;
  drive.name = name("drive");
  drive.sines = {{}, steadySine("0.4")};
  drive.sines[0].amplitude = ex("swing");
  drive.sines[0].frequency = ex("1.3");
  model.excitation = {drive};
  model.system.motions = {{name("a"), name("drive")}};
  model.initial.coordinates = {value("b", "-0.2"), value("x", "0.3")};
  model.initial.speeds.clear();
  return model;
}

TEST(Loops, FollowAPrescribedMotion) {
  ModelSpec model = makeDrivenSliderCrank();
  model.simulation.engine = Engine::kLanes;
  const Eigen::Vector2d point(0.6, 0.22);
  OutputSpec torque;
  torque.name = name("torque");
  torque.reaction = ReactionSpec{name("crank"), ForceComponent::kMomentZ};
  model.outputs.push_back(torque);
  const MatrixXd response = runModel(model, kLoopTimes, point);
  for (Index i = 0; i < kLoopTimes.size(); ++i) {
    const double angle = 0.4 + 0.6 * std::sin(2.0 * EIGEN_PI * 1.3 * kLoopTimes[i]),
                 y = 0.08 * std::sin(angle);
    EXPECT_NEAR(response(i, 0), angle, 1e-12);
    EXPECT_NEAR(response(i, 2), 0.08 * std::cos(angle) + std::sqrt(0.22 * 0.22 - y * y), 1e-9);
  }
  // the torque that such a motion takes, given to the crank that is free, moves it in the same way; not for
  // long, since the spring pushes a free crank away from its dead centre
  ModelSpec free = model;
  free.system.motions.clear();
  const VectorXd times = VectorXd::LinSpaced(801, 0.0, 0.4);
  SignalSpec signal;
  signal.name = name("torque");
  const MatrixXd recorded = runModel(model, times, point);
  signal.tables = {tableOf(std::vector<double>(times.begin(), times.end()),
                           std::vector<double>(recorded.col(3).begin(), recorded.col(3).end()),
                           TableInterpolation::kCubic)};
  free.excitation = {signal};
  free.system.elements.get<Damper>().clear();  // the reaction has the damper's part
  free.system.elements.get<ForceLaw>().push_back(law("a", "torque"));
  free.initial.coordinates.insert(free.initial.coordinates.begin(), value("a", "0.4"));
  free.initial.speeds = {value("a", "0.6 * 2 * pi * 1.3")};
  free.outputs.resize(3);
  free.simulation.duration = 0.35;
  const VectorXd early = VectorXd::LinSpaced(8, 0.0, 0.35);
  EXPECT_LT((runModel(free, early, point) - runModel(model, early, point).leftCols(3)).cwiseAbs().maxCoeff(),
            1e-8);
}

TEST(Loops, HaveExactDerivativesBehindAPrescribedMotion) {
  ModelSpec model = makeDrivenSliderCrank();
  OutputSpec force;
  force.name = name("force");
  model.system.constraints[0].name = name("loop");
  force.force_of = name("loop");
  force.component = ForceComponent::kForceX;
  model.outputs = {coordinateOutput("x"), speedOutput("x"), force};
  expectExactLoopDerivatives(model, Eigen::Vector2d(0.61, 0.225));
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  expectExactLoopDerivatives(model, Eigen::Vector2d(0.61, 0.225));
}

TEST(Loops, MustLeaveSomethingFreeToFollowAMotion) {
  ModelSpec model = makeDrivenSliderCrank();
  model.excitation.push_back(constantSignal("still", "0.2"));
  model.system.motions.push_back({name("x"), name("still")});
  model.system.motions.push_back({name("b"), name("drive")});
  EXPECT_FALSE(getError(model).empty());
  model = makeDrivenSliderCrank();
  model.system.constraints = {gear("x", "a", "0.1")};
  model.system.motions.push_back({name("x"), name("drive")});
  model.initial.coordinates.clear();
  EXPECT_NE(getError(model).find("leave no coordinate free"), std::string::npos) << getError(model);
}

TEST(Loops, MustLeaveSomethingThatMoves) {
  ModelSpec model = makeSliderCrank();
  model.system.constraints.push_back(gear("b", "a", "-0.2"));
  model.initial.coordinates.clear();
  EXPECT_NE(getError(model).find("nothing can move"), std::string::npos) << getError(model);
}

TEST(Motion, RestsWhereItsSignalStarts) {
  // a mass hangs by a spring on a table: at rest m g / k below it, wherever the table is
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("-9.81", "0", "0");
  model.system.bodies = {body("table", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"table"})),
                         body("mass", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.system.elements.get<TwoPointSpring>() = {
      {station("table", kOrigin), station("mass", ex3("1", "0", "0")), ex("400"), ex("1")}};
  model.excitation = {constantSignal("z", "0.03")};
  model.system.motions = {{name("table"), name("z")}};
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  model.outputs = {coordinateOutput("x"), coordinateOutput("table")};
  const MatrixXd response = runModel(model, VectorXd::LinSpaced(3, 0.0, 1.0));
  EXPECT_LT((response.col(0).array() - (0.03 - 2.0 * 9.81 / 400.0)).abs().maxCoeff(), 1e-9);
  EXPECT_LT((response.col(1).array() - 0.03).abs().maxCoeff(), 1e-12);
}

TEST(Loops, TakePartInEquilibriaAndModes) {
  ModelSpec model = makeFourBar();
  model.system.elements.get<Damper>().clear();
  model.system.elements.get<Spring>().push_back({name("a"), ex("3"), ex("1")});
  model.initial.speeds.clear();
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    EXPECT_NEAR(runModel(model, VectorXd::Constant(1, 0.5))(0, 0), golden::kFourBarRest, 1e-8);
    MultibodySimulator simulator(model, VectorXd(), 1);
    MatrixXd response(2, 1);
    SampleStatus status;
    simulator.simulate(VectorXd(), response, &status);
    ASSERT_TRUE(status.ok) << status.reason;
    EXPECT_NEAR(response(0, 0), golden::kFourBarFrequency, 1e-6);
    EXPECT_NEAR(response(1, 0), 0.0, 1e-6);
  }
}

TEST(Loops, AreDescribedWithTheMachine) {
  ModelSpec model = makeFourBar();
  model.system.elements.get<Damper>().clear();
  model.system.elements.get<Spring>().push_back({name("a"), ex("3"), ex("1")});
  const std::vector<std::string> lines =
      MultibodySimulator(model, VectorXd::Constant(1, 0.5)).describeModel();
  std::string text;
  for (const std::string& line : lines) {
    text += line + '\n';
  }
  EXPECT_NE(text.find("coordinates         3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("loops               3 conditions, 1 of them redundant\n"), std::string::npos) << text;
  EXPECT_NE(text.find("degrees of freedom  1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("equilibrium         a 0.9185 rad, b "), std::string::npos) << text;
  EXPECT_NE(text.find("modes               4.423 Hz (damping ratio "), std::string::npos) << text;
}

TEST(Loops, ReportWhatCannotBeClosed) {
  ModelSpec model = makeFourBar();
  model.system.constraints.push_back(
      rod("ground", kOrigin, "rocker", ex3("0.2", "0", "0"), "0.2"));  // fixes the mechanism elsewhere
  model.system.constraints.push_back(rod("ground", kOrigin, "rocker", ex3("0.2", "0", "0"), "0.25"));
  model.system.constraints.back().name = name("brace");
  const std::string error = getError(model);
  EXPECT_NE(error.find("contradict"), std::string::npos) << error;
  EXPECT_NE(error.find("constraint 'brace' is open by"), std::string::npos) << error;
  EXPECT_NE(error.find("system.constraints[1] (rod) is open by"), std::string::npos) << error;
  model = makeFourBar();
  model.system.constraints[0].coincident->from.point = ex3("0.005", "0", "0");
  EXPECT_NE(getError(model).find("(coincident) is open by"), std::string::npos) << getError(model);
}

TEST(Loops, ReportInitialCoordinatesOutOfReach) {
  ModelSpec model = makeSliderCrank();
  // the links reach 0.30; the first is held
  model.initial.coordinates = {value("x", "0.31"), value("a", "0.4"), value("b", "-0.5")};
  EXPECT_NE(getError(model).find("with the initial coordinates that are held"), std::string::npos)
      << getError(model);
}

TEST(Loops, ReportAStartInASingularConfiguration) {
  // a parallelogram that lies flat could open in two ways
  ModelSpec model = makeModel(1.0);
  model.system.bodies.push_back(bar("crank", "0.2", ex3("0.05", "0", "0"), "1e-4", "a", "ground", kOrigin));
  model.system.bodies.push_back(
      bar("coupler", "0.3", ex3("0.1", "0", "0"), "1e-3", "b", "crank", ex3("0.1", "0", "0")));
  model.system.bodies.push_back(
      bar("rocker", "0.2", ex3("0.05", "0", "0"), "1e-4", "c", "ground", ex3("0.2", "0", "0")));
  model.system.constraints = {coincident("coupler", ex3("0.2", "0", "0"), "rocker", ex3("0.1", "0", "0"))};
  model.outputs = {coordinateOutput("a")};
  EXPECT_NE(getError(model).find("singular configuration"), std::string::npos) << getError(model);
  model.initial.coordinates = {value("a", "0.7"), value("b", "-0.7"), value("c", "0.7")};
  EXPECT_EQ(getError(model), "");
}

TEST(Loops, FailASampleThatReachesNoClosedStart) {
  ModelSpec model = makeFourBar();
  model.parameters = {parameter("l", 0.01, 0.45)};
  model.system.constraints[0].coincident->from.point = ex3("l", "0", "0");
  EXPECT_EQ(getReason(model, VectorXd::Constant(1, 0.29)), "");
  const std::string reason = getReason(model, VectorXd::Constant(1, 0.01));
  EXPECT_NE(reason.find("cannot be closed at the start: system.constraints[0] (coincident) is open by"),
            std::string::npos)
      << reason;
}

TEST(Loops, ThatSimbodyMovesHaveTheLimitsOfASample) {
  ModelSpec model = makeFourBar();
  model.simulation.engine = Engine::kSimbody;
  model.simulation.max_steps = 5;
  EXPECT_EQ(getReason(model, VectorXd()).rfind("step limit of 5 reached", 0), 0u);
  model.simulation.max_steps = 100000;
  model.simulation.max_wall_time = 1e-9;
  EXPECT_EQ(getReason(model, VectorXd()).rfind("wall-time limit", 0), 0u);
}

TEST(Loops, OfRedundantRodsAreOne) {
  ModelSpec model = makeFourBar();
  model.system.constraints.push_back(model.system.constraints[0]);
  expectGolden(runModel(model, kLoopTimes), golden::kFourBar, 1e-7);
}

TEST(Loops, AreClosedInStiffIntegration) {
  ModelSpec model = makeFourBar();
  // a filter whose rate forces small explicit steps
  StateSpec filter;
  filter.name = name("z");
  filter.derivative = ex("(a - z) / 1e-7");
  filter.initial = ex("1");
  model.system.states = {filter};
  model.simulation.relative_tolerance = 1e-7;
  model.simulation.absolute_tolerance = 1e-9;
  model.simulation.duration = 0.3;
  model.outputs.resize(1);
  MultibodySimulator simulator(model, VectorXd::Constant(1, 0.25));
  MatrixXd response(1, 1);
  SampleStatus status;
  simulator.simulate(VectorXd(), response, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  EXPECT_TRUE(status.stiff_retry);
  EXPECT_NEAR(response(0, 0), golden::kFourBar[0][0], 1e-5);
}

}  // namespace
}  // namespace twinmap::testing
