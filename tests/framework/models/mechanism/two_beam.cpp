#include "tests/framework/models/mechanism/two_beam.hpp"

#include <cmath>
#include <random>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/model_builder.hpp"

namespace twinmap::testing {
namespace {

constexpr double kMass1 = 3.3, kMass2 = 0.13, kYCom = 0.034, kZCom = 0.022, kInertia = 1.3e-4,
                 kGravity = 9.81;
using State = Eigen::Vector4d;  // y, theta, y', theta'

/// y'' and theta'' solved from the two equations of motion.
Eigen::Vector2d calcAccelerations(const Eigen::Vector4d& p, const State& x, double force, double moment) {
  const double s = std::sin(x[1]), c = std::cos(x[1]);
  const double a = kYCom * s + kZCom * c, b = kYCom * c - kZCom * s;
  const double f1 = force + kMass2 * b * x[3] * x[3] - p[0] * x[2] - p[2] * x[0];
  const double f2 = moment - p[1] * x[3] - p[3] * x[1] - kMass2 * kGravity * b;
  const double m11 = kMass1 + kMass2, m12 = -kMass2 * a;
  const double m22 = kInertia + kMass2 * (kYCom * kYCom + kZCom * kZCom);
  const double determinant = m11 * m22 - m12 * m12;
  return {(m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant};
}

State calcRate(const Eigen::Vector4d& p, const State& x, bool pulse) {
  const Eigen::Vector2d a = calcAccelerations(p, x, pulse ? 5.0 : 0.0, pulse ? 0.075 : 0.0);
  return {x[2], x[3], a[0], a[1]};
}

State advance(const Eigen::Vector4d& p, State x, double length, double step, bool pulse) {
  const int steps = static_cast<int>(std::ceil(length / step - 1e-9));
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {
    const State k1 = calcRate(p, x, pulse);
    const State k2 = calcRate(p, x + 0.5 * h * k1, pulse);
    const State k3 = calcRate(p, x + 0.5 * h * k2, pulse);
    const State k4 = calcRate(p, x + h * k3, pulse);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return x;
}

SystemSpec makeSystem() {
  SystemSpec system;
  system.gravity = ex3("0", "0", "-g");
  system.bodies.push_back(body("beam1", "m1", ex3("0", "0", "0"), ex3("0", "0", "0"),
                               joint(JointType::kSlider, ex3("0", "1", "0"), {"y"})));
  system.bodies.push_back(body("beam2", "m2", ex3("0", "y_com", "z_com"), ex3("I", "I", "I"),
                               joint(JointType::kPin, ex3("1", "0", "0"), {"theta"}, "beam1")));
  system.elements.get<Spring>() = {{name("y"), ex("k_y"), ex("0")}, {name("theta"), ex("k_theta"), ex("0")}};
  system.elements.get<Damper>() = {{name("y"), ex("d_y")}, {name("theta"), ex("d_theta")}};
  system.elements.get<AppliedForce>() = {
      {station("beam1", ex3("0", "0", "0")), ex3("0", "F", "0"), ForceFrame::kGround}};
  system.elements.get<AppliedMoment>() = {{name("beam2"), ex3("M", "0", "0"), ForceFrame::kGround}};
  return system;
}

}  // namespace

ModelSpec makeTwoBeam() {
  ModelSpec model;
  model.parameters = {parameter("d_y", 0.9, 1.1), parameter("d_theta", 1.75e-4, 2.25e-4),
                      parameter("k_y", 5.0, 15.0), parameter("k_theta", 0.027, 0.045)};
  model.constants = {constant("m1", "3.3"),      constant("m2", "0.13"),  constant("y_com", "0.034"),
                     constant("z_com", "0.022"), constant("I", "1.3e-4"), constant("g", "9.81")};
  model.system = makeSystem();
  model.excitation = {pulse("F", "5", "0.2", "0.25"), pulse("M", "0.075", "0.2", "0.25")};
  model.initial.equilibrium = EquilibriumSpec{};
  model.outputs = {coordinateOutput("y"), coordinateOutput("theta")};
  model.simulation.duration = 5.0;
  return model;
}

Eigen::VectorXd makeTwoBeamTimes() {
  return Eigen::VectorXd::LinSpaced(100, 0.05, 5.0);
}

Eigen::MatrixXd makeTwoBeamPoints(int count) {
  std::mt19937_64 generator(20221);
  const ModelSpec model = makeTwoBeam();
  Eigen::MatrixXd points(4, count);
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double unit = static_cast<double>(generator() >> 11) * 0x1p-53;
      const Bounds& bounds = model.parameters[i].bounds;
      points(i, j) = bounds.lower + unit * (bounds.upper - bounds.lower);
    }
  }
  return points;
}

Eigen::Vector2d calcTwoBeamEquilibrium(const Eigen::Vector4d& parameters) {
  double theta = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double s = std::sin(theta), c = std::cos(theta);
    const double torque = parameters[3] * theta + kMass2 * kGravity * (kYCom * c - kZCom * s);
    theta -= torque / (parameters[3] - kMass2 * kGravity * (kYCom * s + kZCom * c));
  }
  return {0.0, theta};
}

Eigen::MatrixXd integrateTwoBeam(const Eigen::Vector4d& parameters, const Eigen::VectorXd& times,
                                 double step_s) {
  const ModelSpec model = makeTwoBeam();
  Eigen::Vector4d center;
  for (int i = 0; i < 4; ++i) {
    center[i] = 0.5 * (model.parameters[i].bounds.lower + model.parameters[i].bounds.upper);
  }
  State x = State::Zero();
  x.head<2>() = calcTwoBeamEquilibrium(center);
  Eigen::MatrixXd result(2, times.size());
  double t = 0.0;
  const double events[] = {0.2, 0.25};
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    for (const double event : events) {
      if (t < event && event <= times[i]) {
        x = advance(parameters, x, event - t, step_s, t >= 0.2 && t < 0.25);
        t = event;
      }
    }
    if (t < times[i]) {
      x = advance(parameters, x, times[i] - t, step_s, t >= 0.2 && t < 0.25);
      t = times[i];
    }
    result.col(i) = x.head<2>();
  }
  return result;
}

}  // namespace twinmap::testing
