// Dampers that begin where something touches: their force jumps there, which is an event. Against closed
// forms and finite differences through the same events.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/exact_events.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Rebound {
  double duration, speed;
};

/// A mass that meets a spring with a damper at the speed v, in and out until the two pull no longer push:
/// depth v / wd exp(-a s) sin(wd s), force k depth + c rate.
Rebound calcRebound(double m, double k, double c, double v) {
  const double a = 0.5 * c / m, wd = std::sqrt(k / m - a * a);
  const double s = (M_PI - std::atan(c * wd / (k - c * a))) / wd;
  return {s, -v / wd * std::exp(-a * s) * (wd * std::cos(wd * s) - a * std::sin(wd * s))};
}

ModelSpec makeMassAtStop() {
  ModelSpec model = makeModel(1.5);
  model.system.bodies = {body("mass", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  Stop<Expression> stop;
  stop.coordinate = name("x");
  stop.below = ex("0");
  stop.stiffness = ex("800");
  stop.damping = ex("12");
  stop.name = name("stop");
  model.system.elements.get<Stop>() = {stop};
  start(model, "x", "0.5", "-1");
  OutputSpec force;
  force.name = name("force");
  force.force_of = name("stop");
  model.outputs = {coordinateOutput("x"), speedOutput("x"), force};
  return model;
}

TEST(Touch, OfAStopWithADamperReboundsAsItsClosedForm) {
  const ModelSpec model = makeMassAtStop();
  const double a = 3.0, wd = std::sqrt(400.0 - a * a);
  const Rebound rebound = calcRebound(2.0, 800.0, 12.0, 1.0);
  VectorXd times(4);
  times << 0.4, 0.5 + 1e-9, 0.55, 1.5;
  const MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 2), 0.0, 1e-12);
  EXPECT_NEAR(result(1, 2), 12.0, 1e-5);  // at once
  const double depth = std::exp(-a * 0.05) / wd * std::sin(wd * 0.05);
  const double rate = std::exp(-a * 0.05) / wd * (wd * std::cos(wd * 0.05) - a * std::sin(wd * 0.05));
  EXPECT_NEAR(result(2, 0), -depth, 1e-9);
  EXPECT_NEAR(result(2, 2), 800.0 * depth + 12.0 * rate, 1e-6);
  EXPECT_NEAR(result(3, 1), rebound.speed, 1e-7);
  // it is let go before the spring is back at its length, and flies on from there
  const double left = -(1.0 / wd) * std::exp(-a * rebound.duration) * std::sin(wd * rebound.duration);
  EXPECT_NEAR(result(3, 0), left + rebound.speed * (1.0 - rebound.duration), 1e-7);
}

TEST(Touch, OfAPointWithAPlaneIsThatOfAStop) {
  ModelSpec model = makeMassAtStop();
  VectorXd times = VectorXd::LinSpaced(9, 0.1, 1.5);
  const MatrixXd expected = runModel(model, times);
  model.system.elements.get<Stop>().clear();
  Contact<Expression> contact;
  contact.station = station("mass", kOrigin);
  contact.plane.normal = ex3("2", "0", "0");
  contact.law.stiffness = ex("800");
  contact.law.dissipation = ex("0");
  contact.damping = ex("12");
  contact.name = name("stop");
  model.system.elements.get<Contact>() = {contact};
  EXPECT_LT((runModel(model, times) - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Touch, HasExactDerivativesThroughEveryBounce) {
  ModelSpec model = makeMassAtStop();
  model.parameters = {parameter("k", 600, 1000), parameter("c", 5, 15), parameter("g", 8, 12)};
  model.system.gravity = ex3("-g", "0", "0");
  model.system.elements.get<Stop>()[0].stiffness = ex("k");
  model.system.elements.get<Stop>()[0].damping = ex("c");
  model.outputs.pop_back();
  expectExactEvents(model, Eigen::Vector3d(800, 12, 9.81), 1.5);
}

TEST(Touch, OfATableThatASignalMovesHasExactDerivatives) {
  // a ball that falls on a shaken table
  ModelSpec model = makeModel(1.0);
  const Expression3 up = ex3("0", "1", "0");
  model.parameters = {parameter("k", 600, 1000), parameter("c", 5, 15), parameter("A", 0.01, 0.03)};
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies = {body("table", "3", kOrigin, kOrigin, joint(JointType::kSlider, up, {"table"})),
                         body("ball", "0.5", kOrigin, kOrigin, joint(JointType::kSlider, up, {"y"}))};
  SignalSpec shake;
  shake.name = name("z");
  shake.sines.push_back({ex("A"), ex("3"), ex("0"), ex("0"), {"", {}}});
  model.excitation = {shake};
  model.system.motions = {{name("table"), name("z")}};
  Contact<Expression> contact;
  contact.station = station("ball", kOrigin);
  contact.plane.body = name("table");
  contact.plane.normal = up;
  contact.law.stiffness = ex("k");
  contact.law.dissipation = ex("0");
  contact.law.exponent = ex("1.5");
  contact.damping = ex("c");
  model.system.elements.get<Contact>() = {contact};
  start(model, "y", "0.2");
  model.outputs = {coordinateOutput("y"), speedOutput("y")};
  expectExactEvents(model, Eigen::Vector3d(800, 10, 0.02), 1.0);
}

TEST(Touch, IsSimulatedInLanesAlone) {
  ModelSpec model = makeMassAtStop();
  model.simulation.engine = Engine::kSimbody;
  EXPECT_NE(getError(model).find("system.stops[0].damping"), std::string::npos) << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
