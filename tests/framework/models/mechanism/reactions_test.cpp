// Forces in joints, of force elements and of constraints: against closed forms, against Simbody's reaction
// forces and multipliers (an engine in lanes is an error unless its outputs are Simbody's), and welds and
// pins that close loops against the joints that they stand for.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/models/mechanism/random_trees.hpp"

namespace twinmap::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr ForceComponent kComponents[] = {ForceComponent::kForceX,  ForceComponent::kForceY,
                                          ForceComponent::kForceZ,  ForceComponent::kMomentX,
                                          ForceComponent::kMomentY, ForceComponent::kMomentZ};

OutputSpec reaction(const std::string& of, ForceComponent component) {
  OutputSpec spec;
  spec.name = name(of + "_" + getEnumText(component));
  spec.reaction = ReactionSpec{name(of), component};
  return spec;
}

OutputSpec forceOf(const std::string& of, std::optional<ForceComponent> component = {}) {
  OutputSpec spec;
  spec.name = name(of + "_" + (component ? getEnumText(*component) : "along"));
  spec.force_of = name(of);
  spec.component = component;
  return spec;
}

OutputSpec formula(const std::string& text, const std::string& unit) {
  OutputSpec spec;
  spec.name = name("formula");
  spec.expression = ex(text);
  spec.unit = unit;
  return spec;
}

/// Pairs of outputs that must be the same at all times, by both engines.
void expectPairs(ModelSpec model, double tolerance = 1e-9) {
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    const MatrixXd response = runModel(model, VectorXd::LinSpaced(7, 0.0, model.simulation.duration));
    for (Index i = 0; i < response.cols(); i += 2) {
      const double largest = response.col(i + 1).cwiseAbs().maxCoeff();
      EXPECT_GT(largest, 0.0) << i;
      EXPECT_LT((response.col(i) - response.col(i + 1)).cwiseAbs().maxCoeff(), tolerance * (1.0 + largest))
          << i;
    }
  }
}

/// A pendulum of 2 kg whose centre of mass is 0.3 m below the hinge.
ModelSpec makePendulum() {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {
      body("arm", "2", ex3("0", "-0.3", "0"), ex3("0.05", "0.05", "0.05"), joint(JointType::kPin, {"q"}))};
  start(model, "q", "0.8", "0.5");
  return model;
}

TEST(Reactions, InAPendulumsHingeAreItsClosedForm) {
  ModelSpec model = makePendulum();
  model.system.bodies[0].joint.name = name("hinge");
  model.system.elements.get<Spring>() = {{name("q"), ex("1.5"), ex("0.2"), name("coil")}};
  model.outputs = {reaction("hinge", ForceComponent::kForceX),
                   formula("2 * 0.3 * (cos(q) * q_ddot - sin(q) * q_dot^2)", "N"),
                   reaction("hinge", ForceComponent::kForceY),
                   formula("2 * (9.81 + 0.3 * (sin(q) * q_ddot + cos(q) * q_dot^2))", "N"),
                   reaction("hinge", ForceComponent::kMomentZ),
                   formula("-1.5 * (q - 0.2)", "N m"),  // what the spring passes on at the joint
                   forceOf("coil"),
                   formula("-1.5 * (q - 0.2)", "N m")};
  expectPairs(model);
  const ResponseLayout layout = MultibodySimulator(model, VectorXd::Zero(1)).getLayout();
  EXPECT_EQ(layout.output_units[0], "N");
  EXPECT_EQ(layout.output_units[4], "N m");
  EXPECT_EQ(layout.output_units[6], "N m");
}

TEST(Reactions, AreInTheAxesOfTheParent) {
  // a mass welded to a turning arm: along the arm it is pulled by m r w^2, whatever the angle
  ModelSpec model = makeModel(1.0);
  JointSpec weld = joint(JointType::kWeld, {}, "arm");
  weld.in_parent.point = ex3("0.5", "0", "0");
  model.system.bodies = {
      body("arm", "1", ex3("0.2", "0", "0"), ex3("0", "0.01", "0.01"), joint(JointType::kPin, {"q"})),
      body("tip", "0.4", ex3("0.1", "0", "0"), kOrigin, weld)};
  start(model, "q", "0.3", "2");
  model.outputs = {reaction("tip", ForceComponent::kForceX), formula("-0.4 * 0.6 * q_dot^2", "N")};
  expectPairs(model);
}

TEST(Reactions, AreSimbodysInEveryJoint) {
  for (const JointType type : listJoints()) {
    ModelSpec model = makeTree(type);
    for (const BodySpec& one : model.system.bodies) {
      for (const ForceComponent component : kComponents) {
        model.outputs.push_back(reaction(one.name.text, component));
      }
    }
    model.simulation.engine = Engine::kLanes;
    EXPECT_EQ(getError(model), "") << getTraits(type).text;
  }
}

TEST(Reactions, OfALoopAreSimbodys) {
  // a body on a ball joint held by a rod and, elsewhere, by a plane: nothing is redundant
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("1", "2", "-9.81");
  model.system.bodies = {body("arm", "0.7", ex3("0.2", "0", "0"), ex3("1e-2", "2e-2", "3e-2"),
                              joint(JointType::kBall, {"q1", "q2", "q3"})),
                         body("rider", "0.3", ex3("0.1", "0", "0.1"), ex3("1e-3", "1e-3", "1e-3"),
                              joint(JointType::kSlider, {"s"}, "arm"))};
  ConstraintSpec rod, plane;
  rod.name = name("rod");
  rod.rod =
      RodSpec{station("ground", ex3("0.3", "0.3", "0")), station("rider", ex3("0.1", "0", "0")), ex("0.35")};
  plane.name = name("plane");
  plane.point_in_plane =
      PointInPlaneSpec{station("arm", ex3("0.3", "0", "0")),
                       PlaneSpec{name("ground"), ex3("0", "0", "0.02"), ex3("0", "1", "5")}};
  model.system.constraints = {rod, plane};
  model.initial.coordinates = {value("q1", "0.2"), value("s", "0.1")};
  model.initial.speeds = {value("q1", "1")};
  for (const ForceComponent component : kComponents) {
    model.outputs.push_back(reaction("arm", component));
    model.outputs.push_back(reaction("rider", component));
    if (!isMoment(component)) {
      model.outputs.push_back(forceOf("rod", component));
      model.outputs.push_back(forceOf("plane", component));
    }
  }
  model.outputs.push_back(forceOf("rod"));
  model.outputs.push_back(forceOf("plane"));
  model.simulation.engine = Engine::kLanes;
  EXPECT_EQ(getError(model), "");
}

TEST(Forces, OfElementsOnCoordinatesAreTheirLaws) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("slide", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"})),
                         body("belt", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"y"}))};
  start(model, "x", "0.2", "1.5");
  start(model, "y", "-0.1", "-0.4");
  model.excitation = {pulse("push", "3", "0", "2")};
  model.system.elements.get<Damper>() = {{name("x"), ex("0.7"), name("damper")}};
  model.system.elements.get<ForceLaw>() = {{name("x"), ex("push - 2 * x^3"), name("motor")}};
  Friction<Expression> friction;
  friction.coordinate = name("x");
  friction.against = name("y");
  friction.coulomb = ex("0.8");
  friction.viscous = ex("0.3");
  friction.bristle.emplace();
  friction.bristle->state = name("z");
  friction.bristle->stiffness = ex("50");
  friction.bristle->damping = ex("0.5");
  friction.bristle->initial = ex("0.001");
  friction.name = name("pad");
  model.system.elements.get<Friction>() = {friction};
  Stop<Expression> stop;
  stop.coordinate = name("x");
  stop.below = ex("0.5");
  stop.stiffness = ex("40");
  stop.name = name("stop");
  model.system.elements.get<Stop>() = {stop};
  const std::string v = "(x_dot - y_dot)";
  model.outputs = {
      forceOf("damper"),
      formula("-0.7 * x_dot", "N"),
      forceOf("motor"),
      formula("push - 2 * x^3", "N"),
      forceOf("pad"),
      formula("-(50 * z + 0.5 * (" + v + " - 50 * abs(" + v + ") * z / 0.8) + 0.3 * " + v + ")", "N"),
      forceOf("stop"),
      formula("40 * max(0.5 - x, 0)", "N")};
  expectPairs(model);
}

TEST(Forces, BetweenBodiesHaveComponentsInGroundAxes) {
  // a ball on a spring and a damper to the origin, blown by a force, above a floor at z = -1
  ModelSpec model = makeModel(0.5);
  model.system.gravity = ex3("0", "0", "-9.81");
  model.system.bodies = {
      body("ball", "0.5", kOrigin, kOrigin, joint(JointType::kTranslation, {"x", "y", "z"}))};
  start(model, "x", "0.6");
  start(model, "y", "0", "0.8");
  start(model, "z", "-1.001");
  model.system.elements.get<TwoPointSpring>() = {
      {station("ground", kOrigin), station("ball", kOrigin), ex("20"), ex("1"), name("spring")}};
  model.system.elements.get<TwoPointDamper>() = {
      {station("ground", kOrigin), station("ball", kOrigin), ex("0.4"), name("damper")}};
  model.system.elements.get<AppliedForce>() = {
      {station("ball", kOrigin), ex3("0.3", "x", "0"), ForceFrame::kGround, name("wind")}};
  model.system.elements.get<AppliedMoment>() = {
      {name("ball"), ex3("0", "0.1", "x"), ForceFrame::kGround, name("twist")}};
  Contact<Expression> contact;
  contact.station = station("ball", kOrigin);
  contact.plane.point = ex3("0", "0", "-1");
  contact.plane.normal = ex3("0", "0", "1");
  contact.law.stiffness = ex("900");
  contact.friction = ex("0.3");
  contact.onset_speed = ex("0.1");
  contact.name = name("floor");
  model.system.elements.get<Contact>() = {contact};
  const std::string r = "sqrt(x^2 + y^2 + z^2)", slip = "sqrt(x_dot^2 + y_dot^2 + 1e-24)",
                    pressure = "900 * max(-1 - z, 0)";
  model.outputs = {forceOf("spring"),
                   formula("20 * (" + r + " - 1)", "N"),
                   forceOf("spring", ForceComponent::kForceX),
                   formula("-20 * (" + r + " - 1) * x / " + r, "N"),
                   forceOf("damper"),
                   formula("0.4 * (x * x_dot + y * y_dot + z * z_dot) / " + r, "N"),
                   forceOf("wind", ForceComponent::kForceY),
                   formula("x", "N"),
                   forceOf("twist", ForceComponent::kMomentZ),
                   formula("x", "N m"),
                   forceOf("floor"),
                   formula(pressure, "N"),
                   forceOf("floor", ForceComponent::kForceZ),
                   formula(pressure, "N"),
                   forceOf("floor", ForceComponent::kForceY),
                   formula("-0.3 * " + pressure + " * tanh(" + slip + " / 0.1) * y_dot / " + slip, "N")};
  expectPairs(model);
}

TEST(Forces, OfABushingActOnItsSecondBody) {
  ModelSpec model = makeModel(0.5);
  model.system.bodies = {body("block", "2", kOrigin, ex3("0.1", "0.1", "0.1"),
                              joint(JointType::kBushing, {"a", "b", "c", "x", "y", "z"}))};
  start(model, "a", "0.2", "0.3");
  start(model, "x", "0.1", "-0.2");
  Bushing<Expression> bushing;
  bushing.from.body = name("ground");
  bushing.to.body = name("block");
  bushing.stiffness = {ex("3"), ex("4"), ex("5"), ex("60"), ex("70"), ex("80")};
  bushing.damping = {ex("0.3"), ex("0"), ex("0"), ex("6"), ex("0"), ex("0")};
  bushing.name = name("mount");
  model.system.elements.get<Bushing>() = {bushing};
  model.outputs = {forceOf("mount", ForceComponent::kForceX), formula("-60 * x - 6 * x_dot", "N"),
                   forceOf("mount", ForceComponent::kMomentX), formula("-3 * a - 0.3 * a_dot", "N m")};
  expectPairs(model);
}

TEST(Forces, OfGearsAndRodsAreTheirClosedForms) {
  // J2 b'' = what the gear exerts on b; a pendulum's rod carries m (g cos + l q'^2)
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {
      body("motor", "1", kOrigin, ex3("0.02", "0.02", "0.02"), joint(JointType::kPin, {"a"})),
      body("wheel", "1", kOrigin, ex3("0.3", "0.3", "0.3"), joint(JointType::kPin, {"b"})),
      body("bob", "0.7", kOrigin, kOrigin, joint(JointType::kPlanar, {"turn", "x", "y"}))};
  model.system.bodies[2].inertia.moments = ex3("1e-3", "1e-3", "1e-3");
  ConstraintSpec gear, rod;
  gear.name = name("mesh");
  gear.gear = GearSpec{name("b"), name("a"), ex("-0.25"), ex("0.5")};
  rod.name = name("string");
  rod.rod = RodSpec{station("ground", kOrigin), station("bob", kOrigin), ex("0.5")};
  model.system.constraints = {gear, rod};
  model.system.elements.get<Spring>() = {{name("a"), ex("2"), ex("0")}};
  start(model, "a", "0.3");
  model.initial.coordinates.push_back(value("x", "0.3"));
  model.initial.coordinates.push_back(value("y", "-0.4"));
  model.outputs = {forceOf("mesh"),
                   formula("0.3 * b_ddot", "N m"),
                   forceOf("string"),
                   formula("0.7 * ((x_dot^2 + y_dot^2) / 0.5 - 9.81 * y / 0.5)", "N"),
                   forceOf("string", ForceComponent::kForceX),
                   formula("0.7 * x_ddot", "N")};
  expectPairs(model, 1e-7);
}

/// The pendulum of makePendulum(), free in space but for a constraint to ground.
ModelSpec makeHeldPendulum(JointType type, const std::vector<std::string>& coordinates) {
  ModelSpec model = makePendulum();
  model.initial = {};
  model.system.bodies[0].joint = joint(type, coordinates);
  return model;
}

TEST(Loops, OfAPinAreAPinJoint) {
  ModelSpec hinged = makePendulum();
  hinged.system.bodies[0].joint.in_parent = {ex3("0.1", "0.2", "0"), ex3("0.4", "-0.3", "0")};
  for (const ForceComponent component : kComponents) {
    hinged.outputs.push_back(reaction("arm", component));
  }
  const VectorXd times = VectorXd::LinSpaced(5, 0.0, 1.0);
  const MatrixXd expected = runModel(hinged, times);
  ModelSpec model = makeHeldPendulum(JointType::kBushing, {"a", "b", "c", "x", "y", "z"});
  model.system.bodies[0].joint.in_parent = hinged.system.bodies[0].joint.in_parent;
  ConstraintSpec pin;
  pin.name = name("pin");
  pin.pin = PinSpec{{name("ground"), {ex3("0.1", "0.2", "0"), ex3("0.4", "-0.3", "0")}}, {name("arm"), {}}};
  model.system.constraints = {pin};
  start(model, "c", "0.8", "0.5");
  for (const ForceComponent component : kComponents) {
    model.outputs.push_back(forceOf("pin", component));
  }
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    EXPECT_LT((runModel(model, times) - expected).cwiseAbs().maxCoeff(),
              1e-5 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(Loops, OfAWeldHoldTheBody) {
  // two bars on one hinge each, welded to one body: a compound pendulum, and the weld carries the second
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  const Expression3 moments = ex3("0.01", "0.01", "0.01");
  model.system.bodies = {body("one", "1", ex3("0.2", "0", "0"), moments, joint(JointType::kPin, {"q"})),
                         body("two", "0.5", ex3("0.1", "0", "0"), moments,
                              joint(JointType::kFree, {"a", "b", "c", "x", "y", "z"}))};
  ConstraintSpec weld;
  weld.name = name("joint");
  weld.weld = WeldSpec{{name("one"), {ex3("0.3", "0", "0"), ex3("0.2", "0.1", "0.5")}},
                       {name("two"), {ex3("-0.1", "0", "0"), ex3("0", "0", "0")}}};
  model.system.constraints = {weld};
  start(model, "q", "-0.4", "1");
  model.initial.coordinates.push_back(value("c", "0.1"));
  model.initial.coordinates.push_back(value("x", "0.4"));
  model.outputs = {coordinateOutput("q")};
  for (const ForceComponent component : kComponents) {
    model.outputs.push_back(forceOf("joint", component));
  }
  ModelSpec tree = model;
  tree.system.constraints.clear();
  JointSpec fixed = joint(JointType::kWeld, {}, "one");
  fixed.in_parent = {ex3("0.3", "0", "0"), ex3("0.2", "0.1", "0.5")};
  fixed.in_body.point = ex3("-0.1", "0", "0");
  tree.system.bodies[1].joint = fixed;
  tree.initial.coordinates.resize(1);
  tree.outputs = {coordinateOutput("q"), reaction("two", ForceComponent::kMomentZ)};
  const VectorXd times = VectorXd::LinSpaced(5, 0.0, 1.0);
  const MatrixXd expected = runModel(tree, times);
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    const MatrixXd response = runModel(model, times);
    EXPECT_LT((response.col(0) - expected.col(0)).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((response.col(6) - expected.col(1)).cwiseAbs().maxCoeff(), 1e-4);  // z of ground and of `one`
  }
}

TEST(Loops, OfPinsAndWeldsAreSimbodysAndHaveExactDerivatives) {
  // a spatial four-bar whose last hinge is a pin in space is overdetermined unless its axes fit: an arm on
  // two hinges that meet in a pin on a third body
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0.5");
  model.parameters = {parameter("l", 0.28, 0.32), parameter("m", 0.2, 0.4)};
  const Expression3 moments = ex3("1e-3", "2e-3", "2e-3");
  JointSpec second = joint(JointType::kPin, {"b"}, "crank"), third = joint(JointType::kPin, {"c"});
  second.in_parent.point = ex3("0.1", "0", "0");
  third.in_parent.point = ex3("0.25", "0", "0");
  model.system.bodies = {body("crank", "0.2", ex3("0.05", "0", "0"), moments, joint(JointType::kPin, {"a"})),
                         body("coupler", "0.3", ex3("0.15", "0", "0"), moments, second),
                         body("rocker", "m", ex3("0.1", "0.01", "0"), moments, third)};
  ConstraintSpec pin;
  pin.name = name("pin");
  pin.pin =
      PinSpec{{name("coupler"), {ex3("l", "0", "0"), {}}}, {name("rocker"), {ex3("0.2", "0", "0"), {}}}};
  model.system.constraints = {pin};
  start(model, "a", "1", "3");
  model.initial.coordinates.push_back(value("b", "-0.677"));
  model.initial.coordinates.push_back(value("c", "1.112"));
  model.outputs = {coordinateOutput("a"), forceOf("pin", ForceComponent::kForceX),
                   forceOf("pin", ForceComponent::kForceY), reaction("rocker", ForceComponent::kForceX)};
  model.simulation.engine = Engine::kLanes;
  model.simulation.relative_tolerance = 1e-11;
  model.simulation.absolute_tolerance = 1e-13;
  const VectorXd times = VectorXd::LinSpaced(4, 0.0, 1.0);
  MultibodySimulator simulator(model, times);
  const Eigen::Vector2d point(0.303, 0.27);
  MatrixXd response(16, 1), derivatives, around(16, 2), points(2, 2);
  SampleStatus status, statuses[2];
  simulator.simulateWithDerivatives(point, response, derivatives, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  for (Index k = 0; k < 2; ++k) {
    const double step = 1e-6;
    points.col(0) = points.col(1) = point;
    points(k, 0) += step;
    points(k, 1) -= step;
    simulator.simulate(points, around, statuses);
    const VectorXd difference = (around.col(0) - around.col(1)) / (2.0 * step);
    for (Index i = 0; i < 4; ++i) {
      const double largest = difference.segment(4 * i, 4).cwiseAbs().maxCoeff();
      EXPECT_LT((derivatives.col(k) - difference).segment(4 * i, 4).cwiseAbs().maxCoeff(), 1e-5 * largest)
          << i << ' ' << k;
    }
  }
}

TEST(Inertia, AboutAJointsAxisIsThatMoment) {
  ModelSpec model = makePendulum();
  model.system.bodies[0].inertia = {};
  model.system.bodies[0].inertia.about_axis = ex("0.05");
  model.outputs = {coordinateOutput("q")};
  const VectorXd times = VectorXd::LinSpaced(5, 0.0, 1.0);
  ModelSpec whole = makePendulum();
  whole.outputs = model.outputs;
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = whole.simulation.engine = engine;
    EXPECT_EQ(runModel(model, times), runModel(whole, times));
  }
  model.system.bodies[0].inertia.about_axis = ex("-0.05");
  EXPECT_NE(getError(model).find("must not be negative"), std::string::npos) << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
