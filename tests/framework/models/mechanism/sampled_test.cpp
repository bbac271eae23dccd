// Sensors that remember, clip and round, prescribed motions and sampled controllers. Against closed forms,
// scipy and finite differences.

#include <cmath>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"
#include "tests/framework/models/mechanism/sampled_golden.hpp"

namespace twinmap::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHalfTurn = 3.141592653589793;
const VectorXd kSampledTimes = VectorXd::LinSpaced(8, 0.25, 2.0);
const Expression3 kRail = ex3("1", "0", "0");

SignalSpec wave(const std::string& text, const std::string& amplitude, const std::string& frequency) {
  SignalSpec spec;
  spec.name = name(text);
  spec.sines.push_back({ex(amplitude), ex(frequency), ex("0"), ex("0"), {"", {}}});
  return spec;
}

OutputSpec sensedOutput(const std::string& text, const std::string& expression, const SensorSpec& sensor) {
  OutputSpec spec;
  spec.name = name(text);
  spec.expression = ex(expression);
  spec.unit = "1";
  spec.sensor = sensor;
  return spec;
}

SensorSpec sensor(const std::string& lag, const std::string& average, const std::string& delay) {
  SensorSpec spec;
  spec.lag = {lag, {}};
  spec.average = {average, {}};
  spec.delay = {delay, {}};
  return spec;
}

void addCart(ModelSpec& model, const std::string& coordinate, const std::string& mass,
             const std::string& parent = "ground") {
  model.system.bodies.push_back(body("on " + coordinate, mass, kOrigin, kOrigin,
                                     joint(JointType::kSlider, kRail, {coordinate}, parent)));
}

/// A free cart, and a sine z of 3 sin(3 pi t) that sensors look at.
ModelSpec makeWatcher(std::vector<SensorSpec> sensors) {
  ModelSpec model = makeModel(2.0);
  addCart(model, "q", "1");
  model.excitation = {wave("z", "3", "1.5")};
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    model.outputs.push_back(sensedOutput("y" + std::to_string(i), "z", sensors[i]));
  }
  return model;
}

/// The largest difference between derivatives and central differences over the bounds' width, of each
/// output's largest or its range. A step of 1e-4 widths leaves some 1e-8 of truncation, and 1e-6 of the
/// integration's error.
double compareDerivatives(const ModelSpec& model, double step = 1e-4) {
  MultibodySimulator simulator(model, kSampledTimes);
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  const VectorXd center = calcBoxCenter(sampled), widths = calcWidths(sampled);
  const Eigen::Index rows = simulator.getLayout().getRowCount(), p = center.size();
  MatrixXd response(rows, 1), derivatives, both(rows, 2), points(p, 2);
  SampleStatus status, statuses[2];
  simulator.simulateWithDerivatives(center, response, derivatives, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  double largest = 0.0;
  for (Eigen::Index k = 0; k < p; ++k) {
    points << center, center;
    points(k, 0) += step * widths[k];
    points(k, 1) -= step * widths[k];
    simulator.simulate(points, both, statuses);
    const VectorXd expected = (both.col(0) - both.col(1)) / (points(k, 0) - points(k, 1));
    for (std::size_t o = 0; o < model.outputs.size(); ++o) {
      const auto n = kSampledTimes.size();
      const VectorXd error = (derivatives.col(k) - expected).segment(static_cast<Eigen::Index>(o) * n, n);
      const double scale = expected.segment(static_cast<Eigen::Index>(o) * n, n).cwiseAbs().maxCoeff();
      const auto values = response.col(0).segment(static_cast<Eigen::Index>(o) * n, n);
      const double range = (values.maxCoeff() - values.minCoeff()) / widths[k];
      largest = std::max(largest, error.cwiseAbs().maxCoeff() / std::max(scale, range));
    }
  }
  return largest;
}

TEST(Sensor, ThatLagsAveragesOrDelaysASineShowsItsClosedForm) {
  const double rate = 3.0 * kHalfTurn, lag = 0.05, window = 0.13, delay = 0.4;
  const ModelSpec model = makeWatcher(
      {sensor("0.05", "", ""), sensor("", "0.13", ""), sensor("", "", "0.4"), sensor("", "0.13", "0.4")});
  const MatrixXd y = runModel(model, kSampledTimes);
  const auto average = [&](double t) {
    const double begin = std::max(t - window, 0.0);
    return t < 0.0 ? 0.0 : 3.0 / (rate * window) * (std::cos(rate * begin) - std::cos(rate * t));
  };
  for (Eigen::Index i = 0; i < kSampledTimes.size(); ++i) {
    const double t = kSampledTimes[i];
    const double lagged =
        3.0 / (1.0 + std::pow(rate * lag, 2)) *
        (std::sin(rate * t) - rate * lag * std::cos(rate * t) + rate * lag * std::exp(-t / lag));
    EXPECT_NEAR(y(i, 0), lagged, 6e-6);
    EXPECT_NEAR(y(i, 1), average(t), 6e-6);
    EXPECT_NEAR(y(i, 2), t < delay ? 0.0 : 3.0 * std::sin(rate * (t - delay)), 6e-6);
    EXPECT_NEAR(y(i, 3), average(t - delay), 6e-6);
  }
}

TEST(Sensor, WithAButterworthFilterIsScipys) {
  SensorSpec filtered;
  filtered.filter = FilterSpec{3, ex("4")};
  ModelSpec model = makeWatcher({filtered});
  model.excitation = {wave("z", "1", "1.5")};
  const VectorXd expected = Eigen::Map<const VectorXd>(golden::kButterworth[0], 8);
  EXPECT_LT((runModel(model, kSampledTimes).col(0) - expected).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Sensor, ThatLagsAveragesAndDelaysSettlesAtTheStart) {
  SensorSpec all = sensor("0.1", "0.2", "0.3");
  all.filter = FilterSpec{4, ex("2")};
  ModelSpec model = makeWatcher({all});
  model.outputs[0].expression = ex("5");
  EXPECT_LT((runModel(model, kSampledTimes).array() - 5.0).abs().maxCoeff(), 1e-9);
}

/// A cart on a spring, driven, whose sensors' times are parameters.
ModelSpec makeSensedCart() {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("k", 20.0, 40.0), parameter("lag", 0.02, 0.06),
                      parameter("window", 0.05, 0.15), parameter("delay", 0.01, 0.3),
                      parameter("cutoff", 3.0, 5.0)};
  addCart(model, "q", "1");
  model.system.elements.get<ForceLaw>().push_back(law("q", "F - k * q - 0.4 * q_dot"));
  model.excitation = {wave("F", "4", "0.7")};
  model.initial.coordinates.push_back(value("q", "0.01 * k"));
  SensorSpec filtered = sensor("", "", "delay");
  filtered.filter = FilterSpec{2, ex("cutoff")};
  model.outputs = {sensedOutput("lagged", "q", sensor("lag", "", "delay")),
                   sensedOutput("averaged", "q_dot", sensor("", "window", "delay / 2")),
                   sensedOutput("filtered", "q_ddot", filtered)};
  return model;
}

TEST(Sensor, HasExactDerivativesWithRespectToItsTimesToo) {
  EXPECT_LT(compareDerivatives(makeSensedCart()), 1e-5);
}

TEST(Sensor, OfARecorderWhoseClockIsEarlyShowsWhatComes) {
  ModelSpec model = makeWatcher({sensor("", "", "-0.1")});
  EXPECT_THROW(MultibodySimulator(model, kSampledTimes), ExperimentError);  // behind the end
  model.simulation.duration = 2.1;
  const MatrixXd y = runModel(model, kSampledTimes);
  for (Eigen::Index i = 0; i < kSampledTimes.size(); ++i) {
    EXPECT_NEAR(y(i, 0), 3.0 * std::sin(3.0 * kHalfTurn * (kSampledTimes[i] + 0.1)), 6e-6);
  }
}

TEST(Sensor, WhoseDelayMayHaveEitherSignHasExactDerivatives) {
  ModelSpec model = makeSensedCart();
  model.parameters[3].bounds = {-0.2, 0.1, {}};
  model.simulation.duration = 2.2;
  EXPECT_LT(compareDerivatives(model), 1e-5);
}

TEST(Sensor, ClipsWithoutADerivativeBeyondItsRange) {
  ModelSpec model = makeSensedCart();
  const MatrixXd free = runModel(model, kSampledTimes, calcBoxCenter(collectSampled(model)));
  model.outputs[0].sensor->range = Bounds{-0.05, 0.1, {}};
  const MatrixXd clipped = runModel(model, kSampledTimes, calcBoxCenter(collectSampled(model)));
  EXPECT_EQ(clipped.col(0), free.col(0).cwiseMin(0.1).cwiseMax(-0.05).eval());
  EXPECT_GT((clipped.col(0) - free.col(0)).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT(compareDerivatives(model), 1e-5);
}

/// A mass on a table: relative to it, with the table prescribed; or on the ground, pulled by the signal.
ModelSpec makeShaker(bool prescribed) {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("k", 150.0, 250.0), parameter("d", 0.5, 3.0), parameter("A", 0.01, 0.03)};
  model.excitation = {wave("z", "A", "1.2")};
  if (prescribed) {
    addCart(model, "table", "7");
    addCart(model, "rel", "2", "on table");
    model.system.elements.get<ForceLaw>() = {law("rel", "-k * rel - d * rel_dot"), law("table", "100")};
    model.system.motions = {{name("table"), name("z")}};
    start(model, "rel", "0", "-A * 2.4 * pi");  // at rest, where the table begins with a speed
  } else {
    addCart(model, "x", "2");
    model.system.elements.get<ForceLaw>() = {law("x", "k * (z - x) + d * (z_dot - x_dot)")};
  }
  const std::string x = prescribed ? "table + rel" : "x";
  model.outputs = {sensedOutput("x", x, {}),
                   sensedOutput("a", prescribed ? "table_ddot + rel_ddot" : "x_ddot", {})};
  return model;
}

TEST(Motion, ThatIsPrescribedMovesWhatHangsOnItByItsSpeedAndAcceleration) {
  const ModelSpec model = makeShaker(true);
  const VectorXd center = calcBoxCenter(collectSampled(model));
  const MatrixXd expected = runModel(makeShaker(false), kSampledTimes, center);
  const MatrixXd response = runModel(model, kSampledTimes, center);
  EXPECT_LT((response - expected).col(0).cwiseAbs().maxCoeff(), 1e-8 * expected.col(0).cwiseAbs().maxCoeff());
  EXPECT_LT((response - expected).col(1).cwiseAbs().maxCoeff(), 1e-8 * expected.col(1).cwiseAbs().maxCoeff());
}

/// A cart that follows a sine, with friction.
ModelSpec makeDrivenCart() {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("m", 1.0, 3.0), parameter("F", 0.5, 2.0), parameter("c", 0.1, 0.4)};
  model.excitation = {wave("z", "0.3", "1.2")};
  addCart(model, "q", "m");
  Friction<Expression> friction;
  friction.coordinate = name("q");
  friction.model = FrictionModel::kCoulomb;
  friction.coulomb = ex("F");
  friction.viscous = ex("c");
  model.system.elements.get<Friction>() = {friction};
  model.system.motions = {{name("q"), name("z")}};
  OutputSpec force;
  force.name = name("force");
  force.force_of = name("q");
  model.outputs = {force};
  return model;
}

TEST(Motion, TakesTheForceThatItsMassAndItsFrictionAskFor) {
  const ModelSpec model = makeDrivenCart();
  const double rate = 2.0 * kHalfTurn * 1.2, size = 0.3;
  const MatrixXd response = runModel(model, kSampledTimes, calcBoxCenter(collectSampled(model)));
  for (Eigen::Index i = 0; i < kSampledTimes.size(); ++i) {
    const double speed = size * rate * std::cos(rate * kSampledTimes[i]);
    const double expected = -2.0 * size * rate * rate * std::sin(rate * kSampledTimes[i]) +
                            std::copysign(1.25, speed) + 0.25 * speed;
    EXPECT_NEAR(response(i, 0), expected, 1e-12 * size * rate * rate) << i;
  }
  EXPECT_LT(compareDerivatives(model), 1e-8);
}

TEST(Motion, OfAllCoordinatesIsKnownAtAnyTimesAlone) {
  const MultibodySimulator whole(makeDrivenCart(), kSampledTimes);
  const Eigen::Array3i kept(1, 4, 7);
  const auto few = whole.cloneAt(kSampledTimes(kept));
  ASSERT_NE(few, nullptr);
  const VectorXd point = Eigen::Vector3d(2.5, 0.7, 0.2);
  MatrixXd responses(8, 1), slopes, few_responses(3, 1), few_slopes;
  SampleStatus status;
  whole.clone()->simulateWithDerivatives(point, responses, slopes, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  few->simulateWithDerivatives(point, few_responses, few_slopes, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  EXPECT_EQ(few_responses, responses(kept, Eigen::all));
  EXPECT_EQ(few_slopes, slopes(kept, Eigen::all));
}

TEST(Motion, IsIntegratedWhereSomethingBesideItIsFree) {
  ModelSpec beside = makeDrivenCart();
  addCart(beside, "x", "1");
  const VectorXd point = Eigen::Vector3d(2.5, 0.7, 0.2);
  EXPECT_EQ(MultibodySimulator(beside, kSampledTimes).cloneAt(kSampledTimes), nullptr);
  EXPECT_LT((runModel(beside, kSampledTimes, point) - runModel(makeDrivenCart(), kSampledTimes, point))
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
}

TEST(Motion, HasExactDerivatives) {
  EXPECT_LT(compareDerivatives(makeShaker(true)), 1e-5);
}

/// make_sampled_golden.py: motor and its PID.
ModelSpec makeSampledMotor(double sample_time, const std::string& delay, const SensorSpec& encoder) {
  ModelSpec model = makeModel(2.0);
  model.system.bodies.push_back(
      body("rotor", "1", kOrigin, ex3("2e-3", "2e-3", "2e-3"), joint(JointType::kPin, {"angle"})));
  StateSpec current;
  current.name = name("i");
  current.derivative = ex("(u - 1.2 * i - 0.05 * angle_dot) / 3e-3");
  model.system.states = {current};
  model.system.elements.get<ForceLaw>().push_back(law("angle", "0.05 * i - 1e-3 * angle_dot"));
  ControllerSpec pid;
  pid.name = name("pid");
  pid.sample_time = sample_time;
  pid.delay = ex(delay);
  pid.reads = {{name("q"), name("encoder")}};
  pid.states = {{name("integral"), ex("integral + " + std::to_string(sample_time) + " * (r - q)"), {}, ""}};
  pid.writes = {
      {name("u"), ex("clamp(20 * (r - q) + 30 * integral - 0.4 * difference(q), -24, 24)"), {}, ""}};
  model.system.controllers = {pid};
  model.excitation = {wave("r", "1", "0.5")};
  model.outputs = {coordinateOutput("angle"), sensedOutput("current", "i", {}),
                   sensedOutput("voltage", "u", {}), sensedOutput("encoder", "angle", encoder)};
  return model;
}

TEST(Sensor, ThatAControllerReadsIsNeverEarly) {
  const ModelSpec model = makeSampledMotor(0.02, "0.005", sensor("", "", "-1e-3"));
  EXPECT_THROW(MultibodySimulator(model, kSampledTimes), ExperimentError);
}

template <std::size_t N>
void expectSampled(const ModelSpec& model, const double (&expected)[N][8]) {
  const MatrixXd response = runModel(model, kSampledTimes);
  for (std::size_t o = 0; o < N; ++o) {
    const VectorXd values = Eigen::Map<const VectorXd>(expected[o], 8);
    EXPECT_LT((response.col(static_cast<Eigen::Index>(o)) - values).cwiseAbs().maxCoeff(),
              1e-6 * (values.maxCoeff() - values.minCoeff()))
        << o;
  }
}

TEST(Controller, AtOneKilohertzWithADelayAboveItsSampleTimeIsScipys) {
  expectSampled(makeSampledMotor(1e-3, "1.5e-3", {}), golden::kPid);
}

TEST(Controller, ReadsAnEncoderThatLagsAndRounds) {
  SensorSpec encoder = sensor("", "", "0.7e-3");
  encoder.quantum = 1e-3;
  expectSampled(makeSampledMotor(2e-3, "0.4e-3", encoder), golden::kEncoder);
}

TEST(Controller, HasExactDerivativesThroughItsDelaysAndSensors) {
  ModelSpec model = makeSampledMotor(0.02, "delay", sensor("lag", "window", "late"));
  model.parameters = {parameter("delay", 0.011, 0.027), parameter("lag", 2e-3, 6e-3),
                      parameter("late", 1e-3, 8e-3),    parameter("window", 0.01, 0.03),
                      parameter("b", 1e-3, 3e-3),       parameter("kp", 0.5, 1.0)};
  model.system.elements.get<ForceLaw>() = {law("angle", "0.05 * i - b * angle_dot")};
  model.system.controllers[0].writes[0].value =
      ex("kp * (r - q) + 0.2 * integral - 0.01 * difference(r - q)");
  EXPECT_LT(compareDerivatives(model), 1e-5);
}

TEST(Controller, PassesAQuantiserInItsDerivatives) {
  ModelSpec model = makeSampledMotor(0.02, "0", {});
  model.parameters = {parameter("kp", 0.5, 1.0)};
  model.system.controllers[0].writes[0].value = ex("kp * (r - q)");
  MatrixXd exact, rounded, response(kSampledTimes.size() * 4, 1);
  SampleStatus status;
  const VectorXd center = calcBoxCenter(collectSampled(model));
  MultibodySimulator(model, kSampledTimes).simulateWithDerivatives(center, response, exact, &status);
  model.outputs[3].sensor->quantum = 1e-6;
  MultibodySimulator(model, kSampledTimes).simulateWithDerivatives(center, response, rounded, &status);
  EXPECT_LT((rounded - exact).cwiseAbs().maxCoeff(), 1e-4 * exact.cwiseAbs().maxCoeff());
}

TEST(Controller, WithoutADelayCascadesWithinAnInstant) {
  ModelSpec model = makeModel(2.0);
  addCart(model, "x", "1");
  ControllerSpec outer, inner;
  outer.name = name("outer");
  outer.sample_time = inner.sample_time = 0.25;
  outer.writes = {{name("a"), ex("t + 1"), ex("-1"), ""}};
  inner.name = name("inner");
  inner.writes = {{name("b"), ex("2 * a"), {}, ""}};
  model.system.controllers = {outer, inner};
  model.outputs = {sensedOutput("A", "a", {}), sensedOutput("B", "b", {})};
  const MatrixXd held = runModel(model, kSampledTimes);
  EXPECT_EQ(held.col(0), (kSampledTimes.array() + 1.0).matrix());
  EXPECT_EQ(held.col(1), 2.0 * held.col(0));
}

TEST(Controller, ShowsItsInitialValueBeforeItsFirstWrite) {
  ModelSpec model = makeModel(2.0);
  addCart(model, "x", "1");
  ControllerSpec late;
  late.name = name("late");
  late.sample_time = 0.1;
  late.delay = ex("0.6");
  late.writes = {{name("a"), ex("t + 1"), ex("-1"), ""}};
  model.system.controllers = {late};
  model.outputs = {sensedOutput("A", "a", {})};
  const MatrixXd held = runModel(model, kSampledTimes);
  EXPECT_EQ(held(0, 0), -1.0);
  EXPECT_EQ(held(1, 0), -1.0);
  EXPECT_NEAR(held(2, 0), 1.1, 1e-12);  // at .75 s shows what was read at .1 s
  EXPECT_NEAR(held(7, 0), 2.4, 1e-12);
}

/// Continuous or sampled laws that the voltage limits most of the time: a kink each time that a limit is met
/// or left, or an instant of the controller.
TEST(Controller, ThatSaturatesHasExactDerivatives) {
  ModelSpec model = makeSampledMotor(0.02, "0.005", {});
  model.parameters = {parameter("kp", 30, 50), parameter("b", 1e-3, 3e-3), parameter("top", 1.0, 1.6)};
  model.system.elements.get<ForceLaw>() = {law("angle", "0.05 * i - b * angle_dot")};
  model.system.controllers[0].writes[0].value =
      ex("clamp(kp * (r - q) + 30 * integral - 0.4 * difference(q), -top, top)");
  EXPECT_LT(compareDerivatives(model), 1e-5);
  model.system.controllers.clear();
  model.system.expressions = {{name("u"), ex("min(max(kp * (r - angle) - 0.4 * angle_dot, -top), top)")}};
  EXPECT_LT(compareDerivatives(model), 1e-5);
}

/// A lift of 2 kg that a controller with an integral holds in place.
ModelSpec makeHeldLift() {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("g", 9, 10), parameter("ki", 20, 60)};
  model.system.gravity = ex3("-g", "0", "0");
  addCart(model, "x", "2");
  model.system.elements.get<ForceLaw>() = {law("x", "u")};
  ControllerSpec hold;
  hold.name = name("hold");
  hold.sample_time = 0.01;
  hold.delay = ex("0.015");
  hold.reads = {{name("q"), name("encoder")}};
  hold.states = {{name("integral"), ex("integral + 0.01 * (0.3 + r - q)"), {}, ""},
                 {name("count"), ex("count + 1"), {}, ""}};
  hold.writes = {
      {name("u"), ex("clamp(80 * (0.3 + r - q) + ki * integral - 8 * difference(q), -90, 90)"), {}, ""}};
  model.system.controllers = {hold};
  model.excitation = {wave("r", "0.01", "1")};
  model.initial.equilibrium.emplace();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  model.outputs = {coordinateOutput("x"), sensedOutput("force", "u", {}),
                   sensedOutput("integral", "integral", {}), sensedOutput("count", "count", {}),
                   sensedOutput("encoder", "x", sensor("0.004", "", "0.002"))};
  return model;
}

TEST(Controller, HoldsAnEquilibriumInItsLoop) {
  ModelSpec model = makeHeldLift();
  model.excitation = {wave("r", "0", "1")};
  const MatrixXd response = runModel(model, kSampledTimes, Eigen::Vector2d(9.5, 40.0));
  for (Eigen::Index i = 0; i < kSampledTimes.size(); ++i) {
    EXPECT_NEAR(response(i, 0), 0.3, 1e-9);
    EXPECT_NEAR(response(i, 1), 2.0 * 9.5, 1e-8);
    EXPECT_NEAR(response(i, 2), 2.0 * 9.5 / 40.0, 1e-9);
    EXPECT_NEAR(response(i, 3), std::floor(kSampledTimes[i] / 0.01 + 1e-6) + 1.0, 1e-9);
  }
  model.initial.equilibrium->at = EquilibriumAt::kBoxCenter;
  EXPECT_NEAR(runModel(model, kSampledTimes, Eigen::Vector2d(9.5, 40.0))(7, 0), 0.3, 1e-9);
}

TEST(Controller, HasExactDerivativesFromAnEquilibriumOn) {
  EXPECT_LT(compareDerivatives(makeHeldLift()), 1e-5);
}

TEST(Motion, ThatJumpsIsRefusedWithItsTime) {
  ModelSpec model = makeShaker(true);
  model.excitation[0].sines[0].start = ex("0.5");
  model.excitation[0].sines[0].phase = ex("1");
  const std::string error = getError(model);
  EXPECT_NE(error.find("'z' cannot prescribe a motion: it jumps by 0.0168 at 0.5 s"), std::string::npos)
      << error;
  model.excitation[0].sines[0].phase = ex("0");
  EXPECT_EQ(getError(model), "");
  model.excitation[0].sines[0].end = ex("0.5 + 2 / 1.2");
  EXPECT_EQ(getError(model), "");
}

TEST(Controller, IsRefusedBySimbodysEngineByItsKey) {
  ModelSpec model = makeSampledMotor(1e-3, "0", {});
  model.simulation.engine = Engine::kSimbody;
  EXPECT_NE(getError(model).find("system.controllers.pid is simulated in lanes only"), std::string::npos)
      << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
