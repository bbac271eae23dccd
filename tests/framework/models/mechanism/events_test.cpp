// Impacts, rest, sticking and sliding: events whose time depends on the solution, against closed forms, scipy
// and finite differences through the same events.

#include <cmath>

#include "framework/experiment/check/check_pairs.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/events_golden.hpp"
#include "tests/framework/models/mechanism/exact_events.hpp"

namespace twinmap::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const Expression3 kAlongX = ex3("1", "0", "0"), kAlongY = ex3("0", "1", "0");

void addSliding(ModelSpec& model, const std::string& coordinate, const std::string& mass,
                const Expression3& axis = kAlongX) {
  model.system.bodies.push_back(body("on " + coordinate, mass, kOrigin, kOrigin,
                                     joint(JointType::kSlider, axis, {coordinate}, "ground")));
}

Stop<Expression> rigidStop(const std::string& coordinate, const std::string& below, const std::string& e) {
  Stop<Expression> stop;
  stop.coordinate = name(coordinate);
  stop.below = ex(below);
  stop.restitution = ex(e);
  return stop;
}

Friction<Expression> dryFriction(const std::string& coordinate, const std::string& coulomb) {
  Friction<Expression> friction;
  friction.coordinate = name(coordinate);
  friction.model = FrictionModel::kCoulomb;
  friction.coulomb = ex(coulomb);
  return friction;
}

SignalSpec sineSignal(const std::string& text, const std::string& amplitude, const std::string& frequency) {
  SignalSpec spec;
  spec.name = name(text);
  spec.sines.push_back({ex(amplitude), ex(frequency), ex("0"), ex("0"), {"", {}}});
  return spec;
}

// ---------------------------------------------------------------------------------------------- impacts

OutputSpec forceOf(const std::string& text) {
  OutputSpec spec;
  spec.name = name("force of " + text);
  spec.force_of = name(text);
  return spec;
}

struct Flight {
  double height, speed;
};

/// A ball from height h at rest under g, thrown back at e times its speed, until the bounces have ended.
Flight calcBall(double e, double g, double h, double t) {
  double speed = std::sqrt(2.0 * g * h), begin = speed / g;
  if (t < begin) {
    return {h - 0.5 * g * t * t, -g * t};
  }
  while (speed > 1e-9) {
    speed *= e;
    const double end = begin + 2.0 * speed / g;
    if (t < end) {
      return {speed * (t - begin) - 0.5 * g * (t - begin) * (t - begin), speed - g * (t - begin)};
    }
    begin = end;
  }
  return {0.0, 0.0};
}

ModelSpec makeBall() {
  ModelSpec model = makeModel(4.0);
  addSliding(model, "y", "0.3", kAlongY);
  model.parameters = {parameter("e", 0.6, 0.9), parameter("g", 9, 10), parameter("h", 0.5, 1.5)};
  model.system.gravity = ex3("0", "-g", "0");
  model.system.elements.get<Stop>() = {rigidStop("y", "0", "e")};
  start(model, "y", "h");
  model.outputs = {coordinateOutput("y"), speedOutput("y")};
  return model;
}

TEST(Impacts, OfABallThatComesToRestAreTheClosedForm) {
  const ModelSpec model = makeBall();
  const VectorXd times = VectorXd::LinSpaced(81, 0.0, 4.0);  // at rest from 3.65 s on
  const Eigen::Vector3d point(0.78, 9.81, 1.0);
  const Solution solution = solveWithDerivatives(model, times, point);
  for (Index i = 0; i < 81; ++i) {
    const Flight flight = calcBall(0.78, 9.81, 1.0, times[i]);
    EXPECT_NEAR(solution.response(i, 0), flight.height, 1e-6) << times[i];
    EXPECT_NEAR(solution.response(81 + i, 0), flight.speed, 1e-6 * 8.9) << times[i];
    for (int k = 0; k < 3; ++k) {
      const double step = 1e-6;
      Eigen::Vector3d above = point, below = point;
      above[k] += step;
      below[k] -= step;
      const Flight a = calcBall(above[0], above[1], above[2], times[i]);
      const Flight b = calcBall(below[0], below[1], below[2], times[i]);
      EXPECT_NEAR(solution.derivatives(i, k), (a.height - b.height) / (2.0 * step), 3e-5) << times[i];
      EXPECT_NEAR(solution.derivatives(81 + i, k), (a.speed - b.speed) / (2.0 * step), 3e-4) << times[i];
    }
  }
  EXPECT_NEAR(solution.response(81 + 80, 0), 0.0, 1e-15);
}

TEST(Impacts, DoNotDependOnTheSamplesBesideThem) {
  const ModelSpec model = makeBall();
  const VectorXd times = VectorXd::LinSpaced(11, 0.0, 4.0);
  MultibodySimulator simulator(model, times);
  MatrixXd points(3, 21), responses(22, 21), alone(22, 1);
  for (Index i = 0; i < 21; ++i) {
    points.col(i) << 0.6 + 0.01 * static_cast<double>(i), 9.5, 0.7;
  }
  std::vector<SampleStatus> statuses(21);
  simulator.simulate(points, responses, statuses.data());
  for (Index i = 0; i < 21; ++i) {
    SampleStatus status;
    simulator.simulate(points.col(i), alone, &status);
    EXPECT_EQ(alone, responses.col(i));
  }
}

TEST(Impacts, BetweenTwoMassesKeepTheMomentum) {
  ModelSpec model = makeModel(1.0);
  addSliding(model, "a", "2");
  addSliding(model, "b", "3");
  Stop<Expression> stop = rigidStop("b", "0.1", "0.5");
  stop.against = name("a");
  model.system.elements.get<Stop>() = {stop};
  start(model, "a", "0", "2");
  start(model, "b", "0.6", "0");
  model.outputs = {speedOutput("a"), speedOutput("b"), coordinateOutput("a"), coordinateOutput("b")};
  const MatrixXd result = runModel(model, VectorXd::Constant(1, 1.0));  // they meet at 0.25 s
  const double common = 2.0 * 2.0 / 5.0, apart = 0.5 * 2.0;
  EXPECT_NEAR(result(0, 0), common - apart * 3.0 / 5.0, 1e-12);
  EXPECT_NEAR(result(0, 1), common + apart * 2.0 / 5.0, 1e-12);
  EXPECT_NEAR(result(0, 3) - result(0, 2), 0.1 + apart * 0.75, 1e-10);
}

/// make_events_golden.py: cart. The pendulum's angle is relative to the cart, which only translates.
ModelSpec makeCartAtWall() {
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  addSliding(model, "x", "2");
  model.system.bodies.push_back(
      body("pendulum", "0.7", ex3("0", "-0.4", "0"), kOrigin, joint(JointType::kPin, {"angle"}, "on x")));
  Stop<Expression> stop = rigidStop("x", "0", "0.6");
  stop.below.reset();
  stop.above = ex("0.1");
  model.system.elements.get<Stop>() = {stop};
  model.system.elements.get<ForceLaw>() = {law("x", "F - 60 * x")};
  model.excitation = {sineSignal("F", "14", "5 / (2 * pi)")};
  start(model, "angle", "0.3");
  model.outputs = {coordinateOutput("x"), coordinateOutput("angle"), speedOutput("x"), speedOutput("angle")};
  return model;
}

TEST(Impacts, OfACartMoveItsPendulumAsScipySays) {
  expectOutputs(makeCartAtWall(), golden::kEventTimes, golden::kCartAtWall);
}

TEST(Impacts, HaveExactDerivativesThroughTheMassMatrix) {
  ModelSpec model = makeCartAtWall();
  model.parameters = {parameter("e", 0.4, 0.8), parameter("wall", 0.05, 0.15), parameter("m", 0.5, 1)};
  model.system.elements.get<Stop>()[0].restitution = ex("e");
  model.system.elements.get<Stop>()[0].above = ex("wall");
  model.system.bodies[1].mass = ex("m");
  expectExactEvents(model, Eigen::Vector3d(0.6, 0.1, 0.7), 2.0);
}

/// A ball thrown up to a height of h under a ceiling a little lower, in one step if nothing stopped it.
TEST(Impacts, OfAFlightThatJustReachesACeilingAreSeen) {
  for (const double share : {0.3, 0.1, 0.01, 1e-4, 1e-8, 0.0, -1e-8, -0.1}) {
    ModelSpec model = makeModel(3.0);
    addSliding(model, "y", "0.3", kAlongY);
    model.system.gravity = ex3("0", "-10", "0");
    Stop<Expression> ceiling;
    ceiling.coordinate = name("y");
    const double speed = 1.0, apex = 0.05, height = apex * (1.0 - share);
    ceiling.above = ex(std::to_string(height));
    ceiling.restitution = ex("0.5");
    model.system.elements.get<Stop>() = {ceiling};
    start(model, "y", "0", std::to_string(speed));
    model.outputs = {coordinateOutput("y")};
    const double limit = std::stod(ceiling.above->text), g = 10.0;
    const double left = speed * speed - 2.0 * g * limit,
                 meets = left < 0.0 ? 3.0 : (speed - std::sqrt(left)) / g;
    const double back = -0.5 * std::sqrt(std::max(left, 0.0)), t = 0.5 - meets;
    const double expected = left < 0.0 ? speed * 0.5 - 0.5 * g * 0.25 : limit + back * t - 0.5 * g * t * t;
    EXPECT_NEAR(runModel(model, VectorXd::Constant(1, 0.5))(0, 0), expected, 1e-7) << share;
  }
}

/// An elastic ball between a floor and a ceiling: its energy decides whether it reaches the ceiling, each
/// time.
TEST(Impacts, BetweenFloorAndCeilingAreSeenInEveryFlight) {
  const double g = 10.0, v = 1.0;  // at height 1/2: up to .55
  for (const double ceiling : {0.501, 0.52, 0.54, 0.549}) {
    ModelSpec model = makeModel(5.0);
    addSliding(model, "y", "0.3", kAlongY);
    model.system.gravity = ex3("0", "-10", "0");
    Stop<Expression> top;
    top.coordinate = name("y");
    top.above = ex(std::to_string(ceiling));
    top.restitution = ex("1");
    model.system.elements.get<Stop>() = {rigidStop("y", "0", "1"), top};
    start(model, "y", "0.5", "1");
    model.outputs = {coordinateOutput("y")};
    const double low = std::sqrt(v * v + 2.0 * g * 0.5), high = std::sqrt(low * low - 2.0 * g * ceiling);
    const double flight = (low - high) / g, begin = -(low - v) / g;  // the floor before the start
    const VectorXd times = VectorXd::LinSpaced(40, 0.1, 5.0);
    const MatrixXd result = runModel(model, times);
    for (int i = 0; i < times.size(); ++i) {
      const double phase = std::fmod(times[i] - begin, 2.0 * flight);
      const double t = std::min(phase, 2.0 * flight - phase);
      EXPECT_NEAR(result(i, 0), low * t - 0.5 * g * t * t, 1e-6) << ceiling << " at " << times[i];
    }
  }
}

TEST(Rest, EndsWhereTheForcePullsAway) {
  // pressed by 3 N less 2 N/s: it leaves at 1.5 s, then x = (2 / m) (t - 1.5)^3 / 6
  ModelSpec model = makeModel(3.0);
  addSliding(model, "x", "m");
  model.parameters = {parameter("m", 1, 2), parameter("F", 2, 4)};
  model.system.elements.get<Stop>() = {rigidStop("x", "0", "0.5")};
  model.system.elements.get<ForceLaw>() = {law("x", "2 * t - F")};
  start(model, "x", "0");
  model.outputs = {coordinateOutput("x")};
  VectorXd times(4);
  times << 0.7, 1.4, 2.0, 3.0;
  const Solution solution = solveWithDerivatives(model, times, Eigen::Vector2d(1.25, 3.0));
  for (int i = 0; i < 4; ++i) {
    const double free = std::max(times[i] - 1.5, 0.0);
    EXPECT_NEAR(solution.response(i, 0), 2.0 / 1.25 * std::pow(free, 3) / 6.0, 1e-9);
    EXPECT_NEAR(solution.derivatives(i, 0), -2.0 / 1.25 / 1.25 * std::pow(free, 3) / 6.0, 1e-7);
    EXPECT_NEAR(solution.derivatives(i, 1), -2.0 / 1.25 * free * free / 2.0 * 0.5, 1e-7);
  }
}

/// A mass whose spring of 30 N/m is relaxed at its rigid stop, at 0.2618 m; from `pulled` s on 3 N pull it
/// away.
ModelSpec makeRelaxedAtStop(double duration, const char* mass, const char* damping, const char* place,
                            const char* pulled) {
  ModelSpec model = makeModel(duration);
  addSliding(model, "x", mass);
  model.system.elements.get<Stop>() = {rigidStop("x", "0.2618", "0")};
  model.system.elements.get<ForceLaw>() = {
      law("x", std::string("F - 30 * (x - 0.2618) - ") + damping + " * x_dot")};
  model.excitation = {pulse("F", "3", pulled, "5")};
  start(model, "x", place);
  model.outputs = {coordinateOutput("x")};
  return model;
}

TEST(Rest, NeedsNoForce) {
  // nothing acts on what lies at its stop until 0.5 s
  VectorXd times(3);
  times << 0.4, 0.5, 1.5;
  const MatrixXd result = runModel(makeRelaxedAtStop(1.5, "2", "0", "0.2618", "0.5"), times);
  EXPECT_EQ(result(0, 0), 0.2618);
  EXPECT_EQ(result(1, 0), 0.2618);
  EXPECT_NEAR(result(2, 0), 0.2618 + 0.1 * (1.0 - std::cos(std::sqrt(15.0))), 1e-8);
}

TEST(Rest, WhereASpringIsRelaxed) {
  // let go 0.3 above the stop, on which it lands, creeps to it or is critically damped; then moved once more
  for (const char* damping : {"0", "2", "8", "13.4", "13.5", "40"}) {
    VectorXd times(3);
    times << 2.0, 3.4, 4.0;
    const MatrixXd result = runModel(makeRelaxedAtStop(4.0, "1.5", damping, "0.5618", "3.5"), times);
    const double natural = std::sqrt(20.0), decay = std::stod(damping) / 3.0;
    if (decay < natural) {
      const bool lands = 2.0 * std::sqrt(natural * natural - decay * decay) > EIGEN_PI;
      EXPECT_NEAR(result(0, 0), 0.2618, lands ? 0.0 : 1e-3) << damping;
    }
    EXPECT_GE(result(1, 0), 0.2618 - 1e-12) << damping;
    EXPECT_GT(result(2, 0), 0.2618 + 0.01) << damping;
  }
}

TEST(Rest, OfWhatFrictionHoldsToo) {
  // thrown against the stop it stays there: friction of 2 N holds what 1 N pulls away, 3 N do not
  ModelSpec model = makeModel(2.0);
  addSliding(model, "x", "1");
  model.system.elements.get<Stop>() = {rigidStop("x", "0", "0")};
  model.system.elements.get<Friction>() = {dryFriction("x", "2")};
  model.system.elements.get<ForceLaw>() = {law("x", "F")};
  model.excitation = {pulse("F", "1", "0.8", "3"), pulse("G", "2", "1.5", "3")};
  model.system.elements.get<ForceLaw>().push_back(law("x", "G"));
  start(model, "x", "0.1", "-1");
  model.outputs = {coordinateOutput("x")};
  VectorXd times(4);
  times << 0.5, 1.2, 1.5, 2.0;
  const MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 0), 0.0, 1e-10);
  EXPECT_NEAR(result(1, 0), 0.0, 1e-10);
  EXPECT_NEAR(result(2, 0), 0.0, 1e-10);
  EXPECT_NEAR(result(3, 0), 0.5 * (3.0 - 2.0) * 0.25, 1e-9);
}

// --------------------------------------------------------------------------------------------- friction

/// A block on a spring from x0 > 0 at rest: half cycles about +-Fc/k, each smaller by 2 Fc/k.
double calcHalfCycles(double m, double k, double coulomb, double x0, double t) {
  const double w = std::sqrt(k / m), shift = coulomb / k;
  double x = x0, begin = 0.0;
  while (std::abs(x) > shift) {
    const double center = x > 0.0 ? shift : -shift;
    if (t < begin + M_PI / w) {
      return center + (x - center) * std::cos(w * (t - begin));
    }
    x = 2.0 * center - x;
    begin += M_PI / w;
  }
  return x;
}

TEST(DryFriction, OnASpringHasHalfCyclesUntilItSticks) {
  ModelSpec model = makeModel(4.0);
  addSliding(model, "x", "m");
  model.parameters = {parameter("m", 1, 2), parameter("k", 40, 60), parameter("Fc", 0.5, 1.5),
                      parameter("x0", 0.1, 0.3)};
  Spring<Expression> spring;
  spring.coordinate = name("x");
  spring.stiffness = ex("k");
  model.system.elements.get<Spring>() = {spring};
  model.system.elements.get<Friction>() = {dryFriction("x", "Fc")};
  start(model, "x", "x0");
  model.outputs = {coordinateOutput("x")};
  const VectorXd times = VectorXd::LinSpaced(37, 0.05, 4.0);
  const Eigen::Vector4d point(1.5, 50.0, 1.0, 0.21);
  const Solution solution = solveWithDerivatives(model, times, point);
  for (Index i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(solution.response(i, 0), calcHalfCycles(1.5, 50.0, 1.0, 0.21, times[i]), 1e-8);
    for (int k = 0; k < 4; ++k) {
      const double step = 1e-6 * point[k];
      Eigen::Vector4d a = point, b = point;
      a[k] += step;
      b[k] -= step;
      const double slope = (calcHalfCycles(a[0], a[1], a[2], a[3], times[i]) -
                            calcHalfCycles(b[0], b[1], b[2], b[3], times[i])) /
                           (2.0 * step);
      EXPECT_NEAR(solution.derivatives(i, k), slope, 1e-6) << k << " at " << times[i];
    }
  }
}

TEST(DryFriction, HoldsUpToItsStaticLevelAndNoMore) {
  // a ramp of 2 N/s: it breaks loose at 1.5 s from 3 N
  ModelSpec model = makeModel(2.5);
  addSliding(model, "x", "2");
  Friction<Expression> friction = dryFriction("x", "3");
  model.system.elements.get<Friction>() = {friction};
  model.system.elements.get<ForceLaw>() = {law("x", "2 * t")};
  model.outputs = {coordinateOutput("x")};
  VectorXd times(3);
  times << 1.0, 1.5, 2.5;
  EXPECT_NEAR(runModel(model, times)(2, 0), 2.0 / 2.0 / 6.0, 1e-9);
  EXPECT_EQ(runModel(model, times)(1, 0), 0.0);
  friction.stribeck = Stribeck<Expression>{ex("5.1"), ex("0.1"), ex("2")};
  model.system.elements.get<Friction>() = {friction};
  EXPECT_EQ(runModel(model, times)(2, 0), 0.0);
}

/// make_events_golden.py: belt.
ModelSpec makeDryBelt() {
  ModelSpec model = makeModel(2.0);
  addSliding(model, "x", "1.5");
  Friction<Expression> friction = dryFriction("x", "2");
  friction.viscous = ex("0.4");
  friction.stribeck = Stribeck<Expression>{ex("3.5"), ex("0.05"), ex("2")};
  friction.surface_speed = ex("0.2");
  model.system.elements.get<Friction>() = {friction};
  model.system.elements.get<ForceLaw>() = {law("x", "-80 * x")};
  model.outputs = {coordinateOutput("x"), speedOutput("x")};
  return model;
}

/// make_events_golden.py: carried.
ModelSpec makeCarried() {
  ModelSpec model = makeModel(2.0);
  addSliding(model, "x1", "3");
  addSliding(model, "x2", "1");
  Friction<Expression> friction = dryFriction("x2", "4");
  friction.against = name("x1");
  model.system.elements.get<Friction>() = {friction};
  model.system.elements.get<ForceLaw>() = {law("x1", "F - 40 * x1")};
  model.excitation = {sineSignal("F", "30", "3 / pi")};
  model.outputs = {coordinateOutput("x1"), coordinateOutput("x2"), speedOutput("x2")};
  return model;
}

TEST(DryFriction, OnABeltSticksAndSlipsAsScipySays) {
  expectOutputs(makeDryBelt(), golden::kEventTimes, golden::kDryBelt);
}

TEST(DryFriction, BetweenTwoBodiesIsScipys) {
  expectOutputs(makeCarried(), golden::kEventTimes, golden::kCarried);
}

TEST(DryFriction, HasExactDerivativesThroughStickAndSlip) {
  ModelSpec model = makeDryBelt();
  model.parameters = {parameter("Fc", 1.5, 2.5), parameter("Fs", 3, 4), parameter("v", 0.1, 0.3),
                      parameter("k", 60, 100)};
  Friction<Expression>& friction = model.system.elements.get<Friction>()[0];
  friction.coulomb = ex("Fc");
  friction.stribeck->level = ex("Fs");
  friction.surface_speed = ex("v");
  model.system.elements.get<ForceLaw>() = {law("x", "-k * x")};
  expectExactEvents(model, Eigen::Vector4d(2.0, 3.5, 0.2, 80.0), 2.0);
  model = makeCarried();
  model.parameters = {parameter("Fc", 3, 5), parameter("m", 0.8, 1.2)};
  model.system.elements.get<Friction>()[0].coulomb = ex("Fc");
  model.system.bodies[1].mass = ex("m");
  expectExactEvents(model, Eigen::Vector2d(4.0, 1.0), 2.0);
}

/// make_events_golden.py: table. The table carries the block as its joint's parent.
ModelSpec makeOnTable() {
  ModelSpec model = makeModel(2.0);
  addSliding(model, "table", "7");
  addSliding(model, "x", "2");
  model.system.bodies[1].joint.parent = name("on table");
  Friction<Expression> friction = dryFriction("x", "6.5");
  friction.name = name("friction");
  model.system.elements.get<Friction>() = {friction};
  model.excitation = {sineSignal("z", "0.1", "1")};
  model.system.motions = {{name("table"), name("z")}};
  start(model, "x", "0", "0");
  model.outputs = {coordinateOutput("x"), speedOutput("x"), forceOf("friction")};
  return model;
}

TEST(DryFriction, OnATableThatASignalMovesIsScipys) {
  expectOutputs(makeOnTable(), golden::kEventTimes, golden::kOnTable);
}

TEST(DryFriction, OnATableThatASignalMovesHasExactDerivatives) {
  ModelSpec model = makeOnTable();
  model.parameters = {parameter("Fc", 5, 7), parameter("A", 0.08, 0.12)};
  model.system.elements.get<Friction>()[0].coulomb = ex("Fc");
  model.excitation = {sineSignal("z", "A", "1")};
  expectExactEvents(model, Eigen::Vector2d(6.5, 0.1), 2.0);
}

TEST(DryFriction, BreaksLooseUnderAForceThatSwingsWhileNothingMoves) {
  ModelSpec model = makeModel(4.0);
  addSliding(model, "x", "2");
  model.system.elements.get<Friction>() = {dryFriction("x", "3")};
  model.system.elements.get<ForceLaw>() = {law("x", "3.2 * sin(2 * pi * 2 * t)")};
  model.outputs = {coordinateOutput("x")};
  const MatrixXd result = runModel(model, VectorXd::Constant(1, 0.3));
  // 2 x'' = 3.2 sin(w t) - 3 from asin(3 / 3.2) / w on, until the next swing
  const double w = 4.0 * M_PI, begin = std::asin(3.0 / 3.2) / w;
  const auto calcSpeed = [&](double t) {
    return (3.2 / w * (std::cos(w * begin) - std::cos(w * t)) - 3.0 * (t - begin)) / 2.0;
  };
  double low = 0.125, high = 0.25;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (calcSpeed(middle) > 0.0 ? low : high) = middle;
  }
  const double end = low, span = end - begin;
  const double path =
      (3.2 / w * (std::cos(w * begin) * span - (std::sin(w * end) - std::sin(w * begin)) / w) -
       1.5 * span * span) /
      2.0;
  EXPECT_GT(path, 1e-4);
  EXPECT_NEAR(result(0, 0), path, 1e-7);
}

TEST(DryFriction, SlidesBackAndOnAgainUnderAForceThatGrows) {
  // m v' = 6 t - 3 - friction of 1 from v = 1/2: v falls as a parabola to -1/6 and returns, but for friction
  ModelSpec model = makeModel(1.5);
  addSliding(model, "x", "1");
  model.system.elements.get<Friction>() = {dryFriction("x", "1")};
  model.system.elements.get<ForceLaw>() = {law("x", "6 * t - 3")};
  start(model, "x", "0", "0.5");
  model.outputs = {speedOutput("x")};
  // on: v = 1/2 - 4 t + 3 t^2 to 0; back while 3 - 6 t > 1: v' = 6 t - 2 from there; then it sticks or turns
  const double halts = (4.0 - std::sqrt(10.0)) / 6.0;
  const auto calcBack = [&](double t) { return 3.0 * (t * t - halts * halts) - 2.0 * (t - halts); };
  VectorXd times(4);
  times << 0.1, 0.3, 0.6, 1.5;
  const double turns = 2.0 / 3.0 - halts;  // v is 0 again, at less than 1/3 + (1/3 - halts)
  const double loose = std::max(turns, 2.0 / 3.0);
  const MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 0), 0.5 - 0.4 + 0.03, 1e-9);
  EXPECT_NEAR(result(1, 0), calcBack(0.3), 1e-9);
  EXPECT_NEAR(result(2, 0), turns > 0.6 ? calcBack(0.6) : 0.0, 1e-9);
  EXPECT_NEAR(result(3, 0), 3.0 * (1.5 * 1.5 - loose * loose) - 4.0 * (1.5 - loose), 1e-9);
}

TEST(DryFriction, ShowsWhatItHoldsWithWhileItSticks) {
  // a ramp of 2 N/s against 3 N; beside it an elastic stop whose place in the list a rigid one takes
  // elsewhere
  ModelSpec model = makeModel(2.5);
  addSliding(model, "x", "2");
  Friction<Expression> friction = dryFriction("x", "3");
  friction.name = name("friction");
  model.system.elements.get<Friction>() = {friction};
  model.system.elements.get<ForceLaw>() = {law("x", "2 * t")};
  Stop<Expression> elastic;
  elastic.coordinate = name("x");
  elastic.below = ex("0.1");
  elastic.stiffness = ex("10");
  elastic.name = name("elastic");
  Stop<Expression> rigid = rigidStop("x", "-1", "0.5");
  rigid.name = name("rigid");
  model.system.elements.get<Stop>() = {rigid, elastic};
  model.outputs = {forceOf("friction"), forceOf("elastic"), forceOf("rigid"), coordinateOutput("x")};
  VectorXd times(4);
  times << 0.25, 0.8, 1.9, 2.5;
  const MatrixXd result = runModel(model, times);
  for (int i = 0; i < 4; ++i) {
    const bool sticks = times[i] < 1.0;  // until 2 t + 1 = 3
    EXPECT_NEAR(result(i, 0), sticks ? -(2.0 * times[i] + 1.0) : -3.0, 1e-9);
    EXPECT_NEAR(result(i, 1), 10.0 * std::max(0.1 - result(i, 3), 0.0), 1e-9);
    EXPECT_EQ(result(i, 2), 0.0);
  }
}

TEST(Rest, ShowsTheForceOfItsStop) {
  ModelSpec model = makeModel(1.0);
  addSliding(model, "y", "0.3", kAlongY);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.elements.get<Stop>() = {rigidStop("y", "0", "0.5")};
  model.system.elements.get<Stop>()[0].name = name("floor");
  start(model, "y", "0");
  model.outputs = {forceOf("floor")};
  EXPECT_NEAR(runModel(model, VectorXd::Constant(1, 0.5))(0, 0), 0.3 * 9.81, 1e-12);
}

/// The piston passes dead centres, where no force at it holds the loop.
TEST(DryFriction, InAClosedLoopHasExactDerivativesThroughDeadCentres) {
  ModelSpec model = makeModel(1.5);
  const auto addBar = [&model](const std::string& text, const std::string& moment,
                               const std::string& coordinate, const std::string& parent,
                               const Expression3& at) {
    BodySpec bar = body(text, "0.4", ex3("0.05", "0", "0"), ex3("0", moment, moment),
                        joint(JointType::kPin, {coordinate}, parent));
    bar.joint.in_parent.point = at;
    model.system.bodies.push_back(bar);
  };
  addBar("crank", "4e-4", "a", "ground", kOrigin);
  addBar("rod", "2e-3", "b", "crank", ex3("0.08", "0", "0"));
  model.system.bodies.push_back(body("piston", "m", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})));
  ConstraintSpec closed;
  closed.coincident = CoincidentSpec{station("rod", ex3("0.22", "0", "0")), station("piston", kOrigin)};
  model.system.constraints = {closed};
  model.parameters = {parameter("m", 0.4, 0.8), parameter("Fc", 1, 3)};
  model.system.elements.get<Friction>() = {dryFriction("x", "Fc")};
  model.system.elements.get<ForceLaw>() = {law("a", "0.6 * sin(7 * t)")};
  start(model, "a", "0.4", "8");
  model.initial.coordinates.push_back(value("b", "-0.5"));
  model.initial.coordinates.push_back(value("x", "0.3"));
  model.outputs = {coordinateOutput("a"), coordinateOutput("x")};
  expectExactEvents(model, Eigen::Vector2d(0.6, 2.0), 1.5);
}

TEST(DryFriction, OfSeveralJointsSticksAndSlipsInEach) {
  // a double pendulum with dry friction in both hinges loses its energy and stays where it sticks
  ModelSpec model = makeModel(6.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  for (const auto& [text, parent] : {std::pair("upper", "ground"), std::pair("lower", "upper")}) {
    BodySpec link = body(text, "1", ex3("0", "-0.3", "0"), ex3("0.01", "0.01", "0.01"),
                         joint(JointType::kPin, {std::string(text) + "_angle"}, parent));
    if (std::string(parent) == "upper") {
      link.joint.in_parent.point = ex3("0", "-0.5", "0");
    }
    model.system.bodies.push_back(link);
  }
  model.system.elements.get<Friction>() = {dryFriction("upper_angle", "0.9"),
                                           dryFriction("lower_angle", "0.4")};
  start(model, "upper_angle", "0.8");
  start(model, "lower_angle", "-0.5");
  model.outputs = {coordinateOutput("upper_angle"), coordinateOutput("lower_angle"),
                   speedOutput("upper_angle"), speedOutput("lower_angle")};
  VectorXd times(2);
  times << 5.0, 6.0;
  const MatrixXd result = runModel(model, times);
  EXPECT_LT((result.row(0) - result.row(1)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(result.rightCols(2).cwiseAbs().maxCoeff(), 1e-12);
  // what the hinges hold there is within their levels
  const double a = result(1, 0), b = result(1, 0) + result(1, 1), g = 9.81;
  EXPECT_LE(std::abs(g * 0.3 * std::sin(b)), 0.4);
  EXPECT_LE(std::abs(g * (0.3 * std::sin(a) + 0.5 * std::sin(a) + 0.3 * std::sin(b))), 0.9);
}

// --------------------------------------------------------------------------------------------- failures

TEST(Switches, FailWithTheirTimeOrReason) {
  ModelSpec model = makeModel(1.0);
  addSliding(model, "x", "1");
  model.system.elements.get<Stop>() = {rigidStop("x", "0", "0.5")};
  start(model, "x", "-0.1");
  model.outputs = {coordinateOutput("x")};
  EXPECT_NE(getReason(model).find("starts at -0.1, beyond 'below: 0'"), std::string::npos)
      << getReason(model);
  model.parameters = {parameter("e", 0.2, 1.4)};
  model.system.elements.get<Stop>() = {rigidStop("x", "-1", "e")};
  const std::string reason = getReason(model, VectorXd::Constant(1, 1.2));
  EXPECT_NE(reason.find("restitution = 1.2 must be from 0 to 1"), std::string::npos) << reason;
}

TEST(Switches, OfWhatASignalMovesAreRefused) {
  ModelSpec model = makeBall();
  model.system.motions = {{name("y"), name("z")}};
  try {
    checkPairs(model);
    FAIL();
  } catch (const ExperimentError& error) {
    EXPECT_NE(std::string(error.what()).find("moves as a signal says"), std::string::npos) << error.what();
  }
}

TEST(Switches, AreSimulatedInLanesAlone) {
  ModelSpec model = makeBall();
  model.simulation.engine = Engine::kSimbody;
  EXPECT_NE(getError(model).find("system.stops[0].restitution is simulated in lanes only"), std::string::npos)
      << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
