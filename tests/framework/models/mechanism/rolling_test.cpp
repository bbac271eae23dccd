// Wheels and balls that roll without slip, against closed forms. An engine in lanes is an error unless its
// accelerations and outputs are those of Simbody's own constraint.

#include <cmath>

#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ConstraintSpec rolling(const std::string& body, const std::string& radius, const std::string& plane,
                       const Expression3& normal) {
  ConstraintSpec constraint;
  constraint.name = name("roll");
  constraint.rolling = RollingSpec{station(body, kOrigin), ex(radius), {name(plane), kOrigin, normal}};
  return constraint;
}

OutputSpec forceOnWheel(std::optional<ForceComponent> component) {
  OutputSpec spec;
  spec.name = name(component ? getEnumText(*component) : "pressure");
  spec.force_of = name("roll");
  spec.component = component;
  return spec;
}

/// A wheel of 2 kg in a plane, under 5 m/s2 along a slope and 8 m/s2 onto it.
ModelSpec makeWheel() {
  ModelSpec model = makeModel(1.5);
  model.parameters = {parameter("J", 0.01, 0.03), parameter("r", 0.08, 0.12)};
  model.system.gravity = ex3("5", "-8", "0");
  model.system.bodies = {
      body("wheel", "2", kOrigin, ex3("J", "J", "J"), joint(JointType::kPlanar, {"turn", "x", "y"}))};
  model.system.constraints = {rolling("wheel", "r", "ground", ex3("0", "2", "0"))};
  model.initial.coordinates = {value("x", "0.3"), value("turn", "0")};
  model.initial.speeds = {value("x", "0.2")};
  model.outputs = {coordinateOutput("x"), coordinateOutput("turn"), coordinateOutput("y"), forceOnWheel({}),
                   forceOnWheel(ForceComponent::kForceX)};
  model.simulation.engine = Engine::kLanes;
  return model;
}

TEST(Rolling, OfAWheelDownASlopeIsItsClosedForm) {
  const ModelSpec model = makeWheel();
  const double J = 0.02, r = 0.1, m = 2.0, mass = m + J / (r * r), a = 5.0 * m / mass, t = 1.5;
  MultibodySimulator simulator(model, VectorXd::Constant(1, t));
  MatrixXd response(5, 1), derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(Eigen::Vector2d(J, r), response, derivatives, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  const double path = 0.2 * t + 0.5 * a * t * t;
  EXPECT_NEAR(response(0), 0.3 + path, 1e-8);
  EXPECT_NEAR(response(1), -path / r, 1e-7);
  EXPECT_NEAR(response(2), r, 1e-10);
  EXPECT_NEAR(response(3), 16.0, 1e-8);
  EXPECT_NEAR(response(4), m * (a - 5.0), 1e-7);
  const double by_mass = -0.5 * t * t * 5.0 * m / (mass * mass);
  EXPECT_NEAR(derivatives(0, 0), by_mass / (r * r), 1e-6);
  EXPECT_NEAR(derivatives(0, 1), by_mass * -2.0 * J / (r * r * r), 1e-6);
  EXPECT_NEAR(derivatives(2, 1), 1.0, 1e-8);
}

TEST(Rolling, OfAWheelLeavesItOneDegreeOfFreedom) {
  std::string text;
  for (const std::string& line :
       MultibodySimulator(makeWheel(), VectorXd::Constant(1, 0.5)).describeModel()) {
    text += line + '\n';
  }
  EXPECT_NE(text.find("3 conditions, 1 of them redundant"), std::string::npos) << text;
  EXPECT_NE(text.find("degrees of freedom  1\n"), std::string::npos) << text;
}

/// A solid ball on a turning table moves in a circle at 2/7 of its rate, wherever it starts (Milne, Vectorial
/// Mechanics, 1948). The table is so heavy that it keeps its rate.
TEST(Rolling, OfABallOnATurningTableGoesRoundInACircle) {
  ModelSpec model = makeModel(2.0);
  model.system.gravity = ex3("0", "0", "-9.81");
  const std::string moment = "0.4 * 0.5 * 0.05^2";
  model.system.bodies = {
      body("table", "1", kOrigin, ex3("1e9", "1e9", "1e9"), joint(JointType::kPin, {"table"})),
      body("ball", "0.5", kOrigin, ex3(moment, moment, moment),
           joint(JointType::kFree, {"a", "b", "c", "x", "y", "z"}))};
  model.system.constraints = {rolling("ball", "0.05", "table", ex3("0", "0", "1"))};
  model.initial.coordinates = {value("x", "0.2"), value("y", "0")};
  model.initial.speeds = {value("table", "3"), value("x", "0.15"), value("y", "0"), value("c", "0")};
  model.outputs = {coordinateOutput("x"), coordinateOutput("y"), coordinateOutput("z")};
  model.simulation.engine = Engine::kLanes;
  const VectorXd times = VectorXd::LinSpaced(8, 0.25, 2.0);
  const MatrixXd response = runModel(model, times);
  const double w = 2.0 / 7.0 * 3.0;
  for (int i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(response(i, 0), 0.2 + 0.15 / w * std::sin(w * times[i]), 1e-7);
    EXPECT_NEAR(response(i, 1), 0.15 / w * (1.0 - std::cos(w * times[i])), 1e-7);
    EXPECT_NEAR(response(i, 2), 0.05, 1e-10);
  }
}

TEST(Rolling, NeedsARadiusAboveZero) {
  ModelSpec model = makeWheel();
  model.system.constraints[0].rolling->radius = ex("-r");
  EXPECT_NE(getError(model).find("radius"), std::string::npos) << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
