// Machines that remember: states of first order, friction with a bristle, springs that yield, and what
// expressions make of them. Against scipy, closed forms, finite differences and the Simbody engine.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/models/mechanism/memory_golden.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTurn = 6.283185307179586;
const Expression3 kSlideAxis = ex3("1", "0", "0");

SignalSpec sine(const std::string& text, const std::string& amplitude, const std::string& frequency) {
  SignalSpec spec;
  spec.name = name(text);
  spec.sines.push_back({ex(amplitude), ex(frequency), ex("0"), ex("0"), {"", {}}});
  return spec;
}

OutputSpec expressionOutput(const std::string& text) {
  OutputSpec spec;
  spec.name = name("output of " + text);
  spec.expression = ex(text);
  spec.unit = "1";
  return spec;
}

StateSpec state(const std::string& text, const std::string& derivative, const std::string& initial = "0") {
  StateSpec spec;
  spec.name = name(text);
  spec.derivative = ex(derivative);
  spec.initial = ex(initial);
  return spec;
}

void addSlider(ModelSpec& model, const std::string& coordinate, const std::string& mass,
               const std::string& parent = "ground") {
  model.system.bodies.push_back(body("on " + coordinate, mass, kOrigin, kOrigin,
                                     joint(JointType::kSlider, kSlideAxis, {coordinate}, parent)));
}

Friction<Expression> lugre(const std::string& coordinate, const std::string& coulomb,
                           const std::string& stiffness, const std::string& damping) {
  Friction<Expression> friction;
  friction.coordinate = name(coordinate);
  friction.coulomb = ex(coulomb);
  friction.bristle.emplace();
  friction.bristle->state = name("z");
  friction.bristle->stiffness = ex(stiffness);
  friction.bristle->damping = ex(damping);
  return friction;
}

/// make_memory_golden.py: slide.
ModelSpec makeSlide() {
  ModelSpec model = makeModel(2.0);
  addSlider(model, "q", "2");
  Friction<Expression> friction = lugre("q", "2", "1e4", "50");
  friction.viscous = ex("0.5");
  friction.stribeck = Stribeck<Expression>{ex("3"), ex("0.05"), ex("2")};
  model.system.elements.get<Friction>().push_back(friction);
  model.system.elements.get<ForceLaw>().push_back(law("q", "F"));
  model.excitation = {sine("F", "4", "1")};
  model.outputs = {coordinateOutput("q"), speedOutput("q"), expressionOutput("z")};
  return model;
}

/// make_memory_golden.py: belt, in coordinates of which the second is relative.
ModelSpec makeBelt() {
  ModelSpec model = makeModel(2.0);
  addSlider(model, "q1", "3");
  addSlider(model, "q2", "1");
  Friction<Expression> friction = lugre("q2", "1.5", "2e3", "10");
  friction.against = name("q1");
  model.system.elements.get<Friction>().push_back(friction);
  model.system.elements.get<ForceLaw>() = {law("q1", "F - 40 * q1"), law("q2", "-30 * q2")};
  model.excitation = {sine("F", "12", "3 / pi")};
  model.outputs = {coordinateOutput("q1"), coordinateOutput("q2"), expressionOutput("z")};
  return model;
}

/// make_memory_golden.py: yielding.
ModelSpec makeYielding() {
  ModelSpec model = makeModel(2.0);
  addSlider(model, "q", "1");
  Hysteresis<Expression> spring;
  spring.coordinate = name("q");
  BoucWen<Expression>& wen = spring.bouc_wen;
  wen.state = name("z");
  wen.stiffness = ex("100");
  wen.elastic_share = ex("0.1");
  wen.yield = ex("0.02");
  wen.beta = ex("0.6");
  wen.gamma = ex("0.4");
  wen.exponent = ex("1.5");
  model.system.elements.get<Hysteresis>().push_back(spring);
  model.system.elements.get<ForceLaw>().push_back(law("q", "F"));
  model.excitation = {sine("F", "3", "0.8")};
  model.outputs = {coordinateOutput("q"), speedOutput("q"), expressionOutput("z")};
  return model;
}

/// make_memory_golden.py: motor.
ModelSpec makeMotor() {
  ModelSpec model = makeModel(2.0);
  model.system.bodies.push_back(
      body("rotor", "1", kOrigin, ex3("2e-3", "2e-3", "2e-3"), joint(JointType::kPin, {"angle"})));
  model.constants = {constant("k_t", "0.05")};
  model.system.states = {state("i", "(u - 1.2 * i - k_t * angle_dot) / 3e-3"),
                         state("filtered", "(i - filtered) / 0.02")};
  model.system.expressions = {{name("torque"), ex("k_t * i")},
                              {name("net"), ex("torque - 1e-3 * angle_dot")}};
  model.system.elements.get<ForceLaw>().push_back(law("angle", "net"));
  model.excitation = {sine("u", "6", "9 / (2 * pi)")};
  model.outputs = {coordinateOutput("angle"), expressionOutput("torque"), expressionOutput("filtered")};
  return model;
}

TEST(Memory, OfASlideWithLugreFrictionIsScipys) {
  expectOutputs(makeSlide(), golden::kTimes, golden::kSlide);
}
TEST(Memory, OfFrictionBetweenTwoCoordinatesIsScipys) {
  expectOutputs(makeBelt(), golden::kTimes, golden::kBelt);
}
TEST(Memory, OfASpringThatYieldsIsScipys) {
  expectOutputs(makeYielding(), golden::kTimes, golden::kYielding);
}
TEST(Memory, OfAMotorsWindingAndAFilterIsScipys) {
  expectOutputs(makeMotor(), golden::kTimes, golden::kMotor);
}

TEST(Memory, IsTheSameBySimbody) {
  for (ModelSpec model : {makeSlide(), makeBelt(), makeYielding(), makeMotor()}) {
    model.simulation.duration = 0.5;
    const VectorXd times = VectorXd::LinSpaced(6, 0.0, 0.5);
    model.simulation.relative_tolerance = 1e-8;
    model.simulation.absolute_tolerance = 1e-10;
    const MatrixXd lanes = runModel(model, times);
    model.simulation.engine = Engine::kSimbody;
    const MatrixXd simbody = runModel(model, times);
    EXPECT_LT((lanes - simbody).cwiseAbs().maxCoeff(), 1e-5 * lanes.cwiseAbs().maxCoeff());
  }
}

/// Exact derivatives against central differences, 1e-3 of the bounds' width to either side. Their solutions
/// share no steps, so that each is integrated as precisely as rounding lets it.
void expectExactDerivatives(ModelSpec model, const VectorXd& point) {
  model.simulation.relative_tolerance = 1e-13;
  model.simulation.absolute_tolerance = 1e-16;
  const VectorXd times = VectorXd::LinSpaced(9, 0.0, model.simulation.duration);
  MultibodySimulator simulator(model, times);
  MatrixXd response(simulator.getLayout().getRowCount(), 1), derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, derivatives, &status);
  ASSERT_TRUE(status.ok && !status.stiff_retry) << status.reason;
  for (Eigen::Index k = 0; k < point.size(); ++k) {
    const double step = 1e-3 * (model.parameters[k].bounds.upper - model.parameters[k].bounds.lower);
    MatrixXd points = point.replicate(1, 2), responses(response.rows(), 2);
    points(k, 0) -= step;
    points(k, 1) += step;
    SampleStatus statuses[2];
    simulator.simulate(points, responses, statuses);
    const VectorXd differences = (responses.col(1) - responses.col(0)) / (2.0 * step);
    for (std::size_t o = 0; o < model.outputs.size(); ++o) {
      const auto rows = Eigen::seqN(static_cast<Eigen::Index>(o) * times.size(), times.size());
      EXPECT_LT((derivatives.col(k)(rows) - differences(rows)).cwiseAbs().maxCoeff(),
                1e-5 * differences(rows).cwiseAbs().maxCoeff())
          << model.parameters[k].name.text << " of " << model.outputs[o].name.text;
    }
  }
}

TEST(Memory, HasExactDerivativesOfFriction) {
  ModelSpec model = makeSlide();
  model.parameters = {parameter("s0", 8e3, 1.2e4), parameter("Fc", 1.5, 2.5), parameter("vs", 0.03, 0.07)};
  Friction<Expression>& friction = model.system.elements.get<Friction>()[0];
  friction.coulomb = ex("Fc");
  friction.bristle->stiffness = ex("s0");
  friction.stribeck->speed = ex("vs");
  expectExactDerivatives(model, Eigen::Vector3d(9.5e3, 2.1, 0.045));
}

TEST(Memory, HasExactDerivativesOfASpringThatYieldsFromItsRestOn) {
  ModelSpec model = makeYielding();
  model.parameters = {parameter("k", 80, 120), parameter("n", 1.2, 2), parameter("yield", 0.01, 0.03)};
  BoucWen<Expression>& wen = model.system.elements.get<Hysteresis>()[0].bouc_wen;
  wen.stiffness = ex("k");
  wen.exponent = ex("n");
  wen.yield = ex("yield");
  expectExactDerivatives(model, Eigen::Vector3d(95, 1.6, 0.021));
}

TEST(Memory, HasExactDerivativesOfStatesAndTheirStart) {
  ModelSpec model = makeMotor();
  model.parameters = {parameter("L", 2e-3, 5e-3), parameter("i0", -1, 1)};
  model.system.states[0] = state("i", "(u - 1.2 * i - k_t * angle_dot) / L", "i0");
  expectExactDerivatives(model, Eigen::Vector2d(3e-3, 0.4));
}

TEST(Memory, OfAStiffBristleIsIntegratedImplicitly) {
  // a bristle of 1e9 N/m that slides: its rate s0 |v| / Fc forces explicit steps of some 1e-8 s, while the
  // motion is that of constant friction
  ModelSpec model = makeModel(1.0);
  model.simulation.relative_tolerance = 1e-7;
  model.simulation.absolute_tolerance = 1e-10;
  addSlider(model, "q", "2");
  model.system.elements.get<Friction>().push_back(lugre("q", "2", "1e9", "0"));
  model.system.elements.get<ForceLaw>().push_back(law("q", "5"));
  start(model, "q", "0", "1");
  model.outputs = {coordinateOutput("q")};
  const VectorXd times = VectorXd::LinSpaced(5, 0.0, 1.0);
  MultibodySimulator simulator(model, times);
  MatrixXd response(5, 1);
  SampleStatus status;
  simulator.simulate(VectorXd(), response, &status);
  ASSERT_TRUE(status.ok && status.stiff_retry) << status.reason;
  const VectorXd expected = times.array() + 0.5 * 1.5 * times.array().square();  // (5 - 2) / 2 m/s2
  EXPECT_LT((response - expected).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Memory, OfAStiffBristleIsIntegratedImplicitlyBehindSensorsToo) {
  // as above, seen late, averaged, and both, from the settled start on
  ModelSpec model = makeModel(1.0);
  model.simulation.relative_tolerance = 1e-7;
  model.simulation.absolute_tolerance = 1e-10;
  model.parameters = {parameter("late", 0.02, 0.2)};
  addSlider(model, "q", "2");
  model.system.elements.get<Friction>().push_back(lugre("q", "2", "1e9", "0"));
  model.system.elements.get<ForceLaw>().push_back(law("q", "5"));
  start(model, "q", "0", "1");
  const auto show = [&](const std::string& delay, const std::string& average) {
    OutputSpec output = expressionOutput("q");
    output.sensor.emplace();
    output.sensor->delay = {delay, {}};
    output.sensor->average = {average, {}};
    model.outputs.push_back(output);
  };
  show("late", "");
  show("", "0.15");
  show("late", "0.15");
  const VectorXd times = VectorXd::LinSpaced(8, 0.05, 1.0);
  MultibodySimulator simulator(model, times);
  MatrixXd response(24, 1), derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(VectorXd::Constant(1, 0.1), response, derivatives, &status);
  ASSERT_TRUE(status.ok && status.stiff_retry) << status.reason;
  const auto path = [](double t) { return t > 0.0 ? t + 0.75 * t * t : 0.0; };
  const auto average = [](double t) {
    const auto integral = [](double u) { return u > 0.0 ? 0.5 * u * u + 0.25 * u * u * u : 0.0; };
    return (integral(t) - integral(t - 0.15)) / 0.15;
  };
  for (int i = 0; i < 8; ++i) {
    const double t = times[i];
    EXPECT_NEAR(response(i), path(t - 0.1), 1e-6) << t;
    EXPECT_NEAR(response(8 + i), average(t), 2e-6) << t;
    EXPECT_NEAR(response(16 + i), average(t - 0.1), 2e-6) << t;
    const double speed = t > 0.1 ? 1.0 + 1.5 * (t - 0.1) : 0.0;
    EXPECT_NEAR(derivatives(i, 0), -speed, 1e-4) << t;
  }
}

TEST(Memory, OfRegularisedFrictionIsNone) {
  // at rest under a load below the Coulomb level it creeps where tanh(v / onset) carries the load
  ModelSpec model = makeModel(3.0);
  addSlider(model, "q", "0.1");
  Friction<Expression> friction;
  friction.coordinate = name("q");
  friction.model = FrictionModel::kRegularised;
  friction.coulomb = ex("2");
  friction.onset_speed = ex("0.01");
  model.system.elements.get<Friction>().push_back(friction);
  model.system.elements.get<ForceLaw>().push_back(law("q", "1"));
  model.outputs = {speedOutput("q"), expressionOutput("q_ddot")};
  const MatrixXd response = runModel(model, VectorXd::Constant(1, 3.0));
  EXPECT_NEAR(response(0, 0), 0.01 * std::atanh(0.5), 1e-9);
  EXPECT_NEAR(response(0, 1), 0.0, 1e-7);
}

/// A mass on a spring, pulled by a coil whose current follows from its voltage.
ModelSpec makeCoil() {
  ModelSpec model = makeModel(1.0);
  addSlider(model, "q", "0.5");
  model.parameters = {parameter("k", 150, 250)};
  model.system.elements.get<Spring>().push_back({name("q"), ex("k"), ex("0")});
  model.system.elements.get<ForceLaw>().push_back(law("q", "4 * i"));
  model.system.states = {state("i", "(12 - 3 * i - 4 * q_dot) / 0.2")};
  model.outputs = {coordinateOutput("q"), expressionOutput("i")};
  return model;
}

TEST(Memory, IsInEquilibriumWithTheRest) {
  ModelSpec model = makeCoil();
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    const MatrixXd response = runModel(model, VectorXd::LinSpaced(3, 0.0, 1.0), VectorXd::Constant(1, 180.0));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(response(i, 0), 4.0 * 4.0 / 180.0, 1e-9);
      EXPECT_NEAR(response(i, 1), 4.0, 1e-9);
    }
  }
}

TEST(Memory, OfABristleIsKeptWhereAnEquilibriumIsSought) {
  // a stuck slide on a spring: the deflection that is given carries its part of the load
  ModelSpec model = makeCoil();
  Friction<Expression> friction = lugre("q", "5", "1e4", "0");
  friction.bristle->initial = ex("1e-4");
  model.system.elements.get<Friction>().push_back(friction);
  model.outputs.push_back(expressionOutput("z"));
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    const MatrixXd response = runModel(model, VectorXd::Zero(1), VectorXd::Constant(1, 200.0));
    EXPECT_NEAR(response(0, 0), (16.0 - 1.0) / 200.0, 1e-9);
    EXPECT_NEAR(response(0, 2), 1e-4, 1e-15);
  }
}

TEST(Memory, IsPartOfTheModes) {
  // det [lambda, -1, 0; k/m, lambda, -4/m; 0, 4/L, lambda + R/L] = 0: the coil damps
  const double m = 0.5, k = 200.0, inductance = 0.2, r = 3.0;
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    ModelSpec model = makeCoil();
    model.simulation.engine = engine;
    MultibodySimulator simulator(model, VectorXd(), 1);
    MatrixXd response(2, 1);
    SampleStatus status;
    simulator.simulate(VectorXd::Constant(1, k), response, &status);
    ASSERT_TRUE(status.ok) << status.reason;
    const double omega = kTurn * response(0, 0), zeta = response(1, 0);
    const std::complex<double> lambda(-zeta * omega, omega * std::sqrt(1.0 - zeta * zeta));
    const std::complex<double> characteristic =
        (lambda * lambda + k / m) * (lambda + r / inductance) + 16.0 / (m * inductance) * lambda;
    EXPECT_LT(std::abs(characteristic), 1e-7 * std::pow(omega, 3));
    EXPECT_GT(zeta, 0.05);
  }
}

TEST(Outputs, OfSignalsRatesAreTheirTimeDerivatives) {
  ModelSpec model = makeModel(1.0);
  addSlider(model, "q", "1");
  SignalSpec sweep, tones, table;
  sweep.name = name("sweep");
  sweep.chirps = {{ex("2"), ex("1"), ex("5"), ex("0.1"), ex("0.9"), SweepKind::kLogarithmic},
                  {ex("1"), ex("3"), ex("2"), ex("0"), ex("1"), SweepKind::kLinear}};
  tones.name = name("tones");
  tones.multisines.emplace_back();
  tones.multisines[0].amplitude = ex("0.5");
  tones.multisines[0].frequencies = {ex("1"), ex("3")};
  table.name = name("table");
  table.tables = {tableOf({0.0, 0.2, 0.5, 0.7, 1.0}, {0.0, 1.0, -1.0, 0.5, 2.0}, TableInterpolation::kCubic),
                  tableOf({0.0, 0.45, 1.0}, {0.0, 1.0, -1.0}, TableInterpolation::kLinear)};
  model.excitation = {sweep, tones, table};
  model.system.elements.get<ForceLaw>().push_back(
      law("q", "tones_dot"));  // so that the speed is tones - tones(0)
  model.outputs = {expressionOutput("sweep"),
                   expressionOutput("tones"),
                   expressionOutput("table"),
                   expressionOutput("sweep_dot"),
                   expressionOutput("tones_dot"),
                   expressionOutput("table_dot"),
                   speedOutput("q"),
                   expressionOutput("sweep_ddot"),
                   expressionOutput("tones_ddot"),
                   expressionOutput("table_ddot")};
  const double h = 1e-4;
  VectorXd times(9);
  times << 0.05, 0.05 + h, 0.05 + 2 * h, 0.4, 0.4 + h, 0.4 + 2 * h, 0.8, 0.8 + h, 0.8 + 2 * h;
  model.simulation.engine = Engine::kLanes;  // an error unless both engines agree
  const MatrixXd response = runModel(model, times);
  for (int i = 0; i < 9; i += 3) {
    const VectorXd slopes = (response.row(i + 2) - response.row(i)).head(3) / (2.0 * h);
    EXPECT_LT((response.row(i + 1).segment(3, 3).transpose() - slopes).cwiseAbs().maxCoeff(), 1e-3);
    const VectorXd bends = (response.row(i + 2) - response.row(i)).segment(3, 3) / (2.0 * h);
    EXPECT_LT((response.row(i + 1).tail(3).transpose() - bends).cwiseAbs().maxCoeff(),
              1e-5 * bends.cwiseAbs().maxCoeff());
    EXPECT_NEAR(response(i, 6), response(i, 1) - 0.5 * std::sin(-EIGEN_PI), 1e-9);
  }
}

TEST(Outputs, OfSensorsOnASwingingArmAreInItsFrame) {
  // a pendulum of length 0.4 m at angle q: along the arm it reads g cos q + l q'^2, across it l q'' + g sin q
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0", "-9.81", "0");
  model.system.bodies.push_back(
      body("arm", "2", ex3("0", "-0.3", "0"), kOrigin, joint(JointType::kPin, {"q"})));
  start(model, "q", "0.8", "0.5");
  const auto sensor = [](const Expression3& direction) {
    return BodySensorSpec{station("arm", ex3("0", "-0.4", "0")), direction};
  };
  OutputSpec across, along_arm, gyro;
  across.specific_force = sensor(ex3("2", "0", "0"));
  along_arm.specific_force = sensor(ex3("0", "1", "0"));
  gyro.angular_velocity = sensor(ex3("0", "0", "1"));
  across.name = name("across");
  along_arm.name = name("along");
  gyro.name = name("gyro");
  model.outputs = {across,
                   along_arm,
                   gyro,
                   expressionOutput("0.4 * q_ddot + 9.81 * sin(q)"),
                   expressionOutput("9.81 * cos(q) + 0.4 * q_dot^2"),
                   speedOutput("q")};
  for (const Engine engine : {Engine::kLanes, Engine::kSimbody}) {
    model.simulation.engine = engine;
    const MatrixXd response = runModel(model, VectorXd::LinSpaced(5, 0.0, 1.0));
    EXPECT_LT((response.leftCols(3) - response.rightCols(3)).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_EQ(MultibodySimulator(model, VectorXd::Zero(1)).getLayout().output_units[2], "rad/s");
}

}  // namespace
}  // namespace twinmap::testing
