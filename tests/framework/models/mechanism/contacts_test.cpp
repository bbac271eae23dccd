// Contacts, stops and backlash against closed forms.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

ModelSpec makeMass(const std::string& mass, double duration) {
  ModelSpec model = makeModel(duration);
  model.system.bodies = {body("mass", mass, kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.outputs = {coordinateOutput("x"), speedOutput("x")};
  return model;
}

ContactLaw<Expression> makeLaw(const std::string& stiffness, const std::string& dissipation = "0") {
  return {ex(stiffness), ex(dissipation), {}};
}

TEST(Stops, ThrowBackAfterHalfAPeriodOfTheirSpring) {
  // free from 0.5 at -1 m/s to 0, then x = -sin(w t) / w over half a period, then free at 1 m/s
  ModelSpec model = makeMass("2", 1.5);
  Stop<Expression> stop;
  stop.coordinate = name("x");
  stop.below = ex("0");
  stop.stiffness = ex("800");
  model.system.elements.get<Stop>() = {stop};
  start(model, "x", "0.5", "-1");
  const double w = 20.0, leaves = 0.5 + M_PI / w;
  Eigen::VectorXd times(4);
  times << 0.25, 0.55, 0.5 + 0.5 * M_PI / w, 1.5;
  const Eigen::MatrixXd result = runModel(model, times);
  EXPECT_NEAR(result(0, 0), 0.25, 1e-9);
  EXPECT_NEAR(result(1, 0), -std::sin(w * 0.05) / w, 1e-8);
  EXPECT_NEAR(result(2, 0), -1.0 / w, 1e-8);
  EXPECT_NEAR(result(3, 0), 1.5 - leaves, 1e-7);
}

/// u with G(-u) = G(v), G(v) = v / a - log(1 + a v) / a^2: m v dv/dx = -k x^n (1 + a v), integrated from the
/// first touch to the last, whatever n.
double calcRebound(double v, double a) {
  const auto calc = [a](double x) { return x / a - std::log1p(a * x) / (a * a); };
  double low = 0.0, high = v;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (calc(-middle) < calc(v) ? low : high) = middle;
  }
  return low;
}

TEST(Stops, AboveAreTheMirrorImageOfBelow) {
  for (const bool above : {false, true}) {
    ModelSpec model = makeMass("2", 1.0);
    Stop<Expression> stop;
    stop.coordinate = name("x");
    (above ? stop.above : stop.below) = ex(above ? "0.1" : "-0.1");
    stop.stiffness = ex("800");
    stop.dissipation = ex("0.2");
    stop.exponent = ex("1.5");
    model.system.elements.get<Stop>() = {stop};
    start(model, "x", "0", above ? "1" : "-1");
    EXPECT_NEAR((above ? -1.0 : 1.0) * runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 1),
                calcRebound(1.0, 0.2), 1e-7);
  }
}

TEST(Stops, LoseWhatHuntAndCrossleyState) {
  for (const std::string exponent : {"1", "1.5", "2.3"}) {
    ModelSpec model = makeMass("2", 1.0);
    Stop<Expression> stop;
    stop.coordinate = name("x");
    stop.below = ex("0");
    stop.stiffness = ex("2000");
    stop.dissipation = ex("0.3");
    stop.exponent = ex(exponent);
    model.system.elements.get<Stop>() = {stop};
    start(model, "x", "0.1", "-1.2");
    EXPECT_NEAR(runModel(model, Eigen::VectorXd::Constant(1, 1.0))(0, 1), calcRebound(1.2, 0.3), 1e-7)
        << exponent;
  }
}

TEST(Backlash, HasThePeriodOfFreeAndPressedParts) {
  // from +gap/2 at v: across the gap and back twice, and two half periods of the spring
  ModelSpec model = makeMass("2", 1.0);
  Backlash<Expression> backlash;
  backlash.coordinate = name("x");
  backlash.gap = ex("0.2");
  backlash.law = makeLaw("800");
  model.system.elements.get<Backlash>() = {backlash};
  start(model, "x", "0.1", "0.5");
  const double period = 2.0 * 0.2 / 0.5 + 2.0 * M_PI / 20.0;
  model.simulation.duration = period;
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, period));
  EXPECT_NEAR(result(0, 0), 0.1, 1e-7);
  EXPECT_NEAR(result(0, 1), 0.5, 1e-7);
}

TEST(Backlash, HasNoNegativeGap) {
  ModelSpec model = makeMass("2", 1.0);
  Backlash<Expression> backlash;
  backlash.coordinate = name("x");
  backlash.gap = ex("-0.2");
  backlash.law = makeLaw("800");
  model.system.elements.get<Backlash>() = {backlash};
  EXPECT_NE(getError(model).find("gap = -0.2 must not be negative"), std::string::npos) << getError(model);
}

TEST(Backlash, BetweenTwoCoordinatesKeepsTheMomentum) {
  ModelSpec model = makeModel(2.0);
  model.system.bodies = {body("motor", "2", kOrigin, kOrigin, joint(JointType::kSlider, {"a"})),
                         body("load", "3", kOrigin, kOrigin, joint(JointType::kSlider, {"b"}))};
  Backlash<Expression> backlash;
  backlash.coordinate = name("b");
  backlash.against = name("a");
  backlash.gap = ex("0.05");
  backlash.law = makeLaw("500", "0.1");
  model.system.elements.get<Backlash>() = {backlash};
  start(model, "a", "0", "1");
  model.outputs = {speedOutput("a"), speedOutput("b")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::LinSpaced(9, 0.0, 2.0));
  for (int i = 0; i < result.rows(); ++i) {
    EXPECT_NEAR(2.0 * result(i, 0) + 3.0 * result(i, 1), 2.0, 1e-9);
  }
  EXPECT_GT(std::abs(result(8, 1)), 0.1);
}

TEST(Contacts, SlideDownASlope) {
  ModelSpec model = makeModel(2.0);
  // x down a slope of 30 degrees, y off it
  model.system.gravity = ex3("5", "-8.660254037844386", "0");
  model.system.bodies = {
      body("block", "2", kOrigin, ex3("1", "1", "1"), joint(JointType::kPlanar, {"turn", "x", "y"}))};
  Contact<Expression> contact;
  contact.station = station("block", kOrigin);
  contact.plane.normal = ex3("0", "2", "0");
  contact.law = makeLaw("1e4", "1");
  contact.friction = ex("0.2");
  contact.onset_speed = ex("1e-3");
  model.system.elements.get<Contact>() = {contact};
  start(model, "y", "-8.660254037844386 * 2 / 1e4");
  start(model, "x", "0", "0.5");
  model.outputs = {coordinateOutput("x"), coordinateOutput("y")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 2.0));
  const double acceleration = 5.0 - 0.2 * 8.660254037844386;
  EXPECT_NEAR(result(0, 0), 0.5 * 2.0 + 0.5 * acceleration * 4.0, 1e-6);
  EXPECT_NEAR(result(0, 1), -8.660254037844386 * 2.0 / 1e4, 1e-9);
}

TEST(Contacts, PushBothBodies) {
  // a particle falls onto a table that is free to move along y: together they keep their momentum
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {
      body("table", "3", kOrigin, kOrigin, joint(JointType::kSlider, ex3("0", "1", "0"), {"table_y"})),
      body("particle", "2", kOrigin, kOrigin, joint(JointType::kSlider, ex3("0", "1", "0"), {"y"}))};
  Contact<Expression> contact;
  contact.station = station("particle", kOrigin);
  contact.plane.body = name("table");
  contact.plane.point = ex3("0", "0.1", "0");
  contact.plane.normal = ex3("0", "1", "0");
  contact.law = makeLaw("1e3");
  model.system.elements.get<Contact>() = {contact};
  start(model, "y", "0.3", "-1");
  model.outputs = {speedOutput("y"), speedOutput("table_y")};
  const Eigen::MatrixXd result = runModel(model, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_NEAR(result(0, 0), -1.0 + 2.0 * 3.0 / 5.0, 1e-7);  // elastic impact
  EXPECT_NEAR(result(0, 1), -2.0 * 2.0 / 5.0, 1e-7);
}

}  // namespace
}  // namespace twinmap::testing
