// The lanes against Simbody: every joint, element, excitation, output, start and failure.

#include <limits>
#include <random>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/lanes/compare_with_simbody.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "tests/framework/models/mechanism/random_trees.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

/// Responses (rows x points) by one engine; every sample must succeed.
Eigen::MatrixXd runBy(Engine engine, ModelSpec model, const Eigen::VectorXd& times,
                      const Eigen::MatrixXd& points, int modes = 0) {
  model.simulation.engine = engine;
  MultibodySimulator simulator(model, times, modes);
  Eigen::MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  simulator.simulate(points, responses, statuses.data());
  for (const SampleStatus& status : statuses) {
    EXPECT_TRUE(status.ok) << status.reason;
  }
  return responses;
}

/// Both engines integrate within their tolerance; `tolerance` is of each output's range.
void expectSameResponses(const ModelSpec& model, const Eigen::MatrixXd& points, double tolerance) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(21, 0.0, model.simulation.duration);
  const Eigen::MatrixXd lanes = runBy(Engine::kLanes, model, times, points);
  const Eigen::MatrixXd simbody = runBy(Engine::kSimbody, model, times, points);
  for (std::size_t o = 0; o < model.outputs.size(); ++o) {
    const auto rows = Eigen::seqN(static_cast<Eigen::Index>(o) * times.size(), times.size());
    const double range = 1e-3 + simbody(rows, Eigen::all).maxCoeff() - simbody(rows, Eigen::all).minCoeff();
    EXPECT_LT((lanes(rows, Eigen::all) - simbody(rows, Eigen::all)).cwiseAbs().maxCoeff(), tolerance * range)
        << model.outputs[o].name.text;
  }
}

Eigen::MatrixXd makePoints(const ModelSpec& model, int count) {
  std::mt19937 generator(7);
  Eigen::MatrixXd points(static_cast<Eigen::Index>(model.parameters.size()), count);
  for (int j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const Bounds& bounds = model.parameters[i].bounds;
      points(i, j) =
          bounds.lower + (bounds.upper - bounds.lower) * static_cast<double>(generator()) / 4294967296.0;
    }
  }
  return points;
}

class LanesOfEveryJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(LanesOfEveryJoint, MoveAndMeasureAsSimbodyDoes) {
  ModelSpec model = makeTree(GetParam());
  addAllOutputs(model);
  model.simulation.duration = 0.3;  // longer, the trees tumble chaotically or pass singular angles
  model.parameters = {parameter("k", 5.0, 9.0), parameter("weight", 0.2, 0.4)};
  model.system.elements.get<Spring>()[0].stiffness = ex("k");
  model.system.bodies[2].mass = ex("weight");
  expectSameResponses(model, makePoints(model, 11), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(AllTypes, LanesOfEveryJoint, ::testing::ValuesIn(listJoints()));

TEST(Lanes, CarryBushings) {
  ModelSpec model = makeBushedBodies();
  for (const std::string& own : makeNames("q", JointType::kFree)) {
    model.outputs.push_back(coordinateOutput(own));
  }
  start(model, "q0", "0.2", "1");
  start(model, "p4", "0.1", "-1");
  model.simulation.duration = 0.5;
  expectSameResponses(model, Eigen::MatrixXd(0, 3), 1e-6);
}

/// A damped oscillator under a signal u; parameters amplitude a and time t0.
ModelSpec makeDriven() {
  ModelSpec model = makeModel(3.0);
  model.parameters = {parameter("a", 1.0, 2.0), parameter("t0", 0.3, 0.9), parameter("c", 0.1, 0.5)};
  model.system.bodies = {body("block", "1.5", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.system.elements.get<Spring>() = {{name("x"), ex("40"), ex("0.1")}};
  model.system.elements.get<Damper>() = {{name("x"), ex("c")}};
  model.system.elements.get<ForceLaw>() = {law("x", "u + 0.1 * sin(3 * t) - 0.2 * x^3 * abs(x_dot)")};
  model.outputs = {coordinateOutput("x"), speedOutput("x")};
  model.outputs[1].gain = ex("1 + 0.1 * a");
  model.outputs[1].offset = ex("0.3 * c");
  return model;
}

/// The same, recorded by a clock that is late by `delay`.
SignalSpec makeLate(SignalSpec signal, const std::string& delay) {
  for (TableSpec& table : signal.tables) {
    table.measured.emplace().delay = ex(delay);
  }
  return signal;
}

std::vector<std::pair<std::string, SignalSpec>> makeSignals() {
  SignalSpec empty;
  empty.name = name("u");
  SignalSpec sine = empty, chirp = empty, log_chirp = empty, multisine = empty, linear = empty, hold = empty,
             cubic = empty, sum = empty;
  sine.sines = {{ex("a"), ex("0.5 + a"), ex("0.3"), ex("t0"), ex("2.1")}};
  chirp.chirps = {{ex("a"), ex("0.5"), ex("a * 2"), ex("t0"), ex("t0 + 1.5"), SweepKind::kLinear}};
  log_chirp.chirps = {{ex("a"), ex("0.5"), ex("3"), ex("0"), ex("2.5"), SweepKind::kLogarithmic}};
  multisine.multisines = {{ex("a"), {}, {ex("0.4"), ex("1.1"), ex("2.3")}, {}, ex("0.2"), ex("")}};
  const std::vector<double> times{0.1, 0.5, 0.5, 1.3, 2.0, 2.2}, values{0.0, 1.0, -1.0, 2.0, 0.5, 0.0};
  linear.tables = {tableOf(times, values, TableInterpolation::kLinear)};
  hold.tables = {tableOf(times, values, TableInterpolation::kHold)};
  cubic.tables = {tableOf({0.1, 0.5, 0.9, 1.3, 2.0, 2.2}, values, TableInterpolation::kCubic)};
  sum.pulses = {{ex("a"), ex("t0"), ex("t0 + 0.2")}, {ex("-2"), ex("0.5"), ex("1")}};
  sum.sines = sine.sines;
  sum.tables = {linear.tables[0], cubic.tables[0]};
  return {{"pulse", pulse("u", "a", "t0", "1.5")},
          {"sine", sine},
          {"chirp", chirp},
          {"logarithmic chirp", log_chirp},
          {"multisine", multisine},
          {"linear table", linear},
          {"hold table", hold},
          {"cubic table", cubic},
          {"late linear table", makeLate(linear, "t0 - 0.6")},
          {"late hold table", makeLate(hold, "t0 - 0.6")},
          {"late cubic table", makeLate(cubic, "0.3 * a - t0")},
          {"sum", sum}};
}

TEST(Lanes, FollowEveryExcitation) {
  for (const auto& [what, signal] : makeSignals()) {
    SCOPED_TRACE(what);
    ModelSpec model = makeDriven();
    model.excitation = {signal};
    expectSameResponses(model, makePoints(model, 9), 1e-7);
  }
}

TEST(Lanes, HaveALateTableEarlier) {
  const std::vector<double> times{0.1, 0.5, 0.9, 1.3, 2.0, 2.2}, values{0.0, 1.0, -1.0, 2.0, 0.5, 0.0};
  SignalSpec early;
  early.name = name("u");
  early.tables = {tableOf(times, values, TableInterpolation::kCubic)};
  SignalSpec late = early;
  for (double& t : late.tables[0].times) {
    t += 0.25;
  }
  ModelSpec model = makeDriven();
  const Eigen::VectorXd at = Eigen::VectorXd::LinSpaced(21, 0.0, 3.0);
  model.excitation = {makeLate(late, "0.25")};
  const Eigen::MatrixXd found = runBy(Engine::kLanes, model, at, makePoints(model, 3));
  model.excitation = {early};
  EXPECT_LT((found - runBy(Engine::kLanes, model, at, makePoints(model, 3))).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Lanes, FollowNuisanceParametersInputsAndConstants) {
  ModelSpec model = makeDriven();
  model.excitation = {pulse("u", "lift", "t0", "1.5")};
  model.nuisance = {parameter("x0", -0.1, 0.1)};
  model.inputs = {parameter("load", 1.0, 2.0)};
  model.constants = {constant("lift", "a * load + 1")};
  start(model, "x", "x0", "load / 10");
  Eigen::MatrixXd points(5, 3);
  points << 1.0, 1.5, 2.0, 0.3, 0.5, 0.9, 0.1, 0.2, 0.5, -0.1, 0.0, 0.1, 1.0, 1.5, 2.0;
  expectSameResponses(model, points, 1e-7);
}

TEST(Lanes, StartAtTheSamplesOwnEquilibrium) {
  ModelSpec model = makeTwoBeam();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  expectSameResponses(model, makeTwoBeamPoints(9), 2e-5);
}

TEST(Lanes, StartOfABallJointTurnsItsRatesIntoAngularVelocity) {
  ModelSpec model = makeModel(0.5);
  model.system.bodies = {body("top", "1", ex3("0", "0", "0.1"), ex3("0.02", "0.02", "0.03"),
                              joint(JointType::kBall, {"a", "b", "c"}))};
  start(model, "a", "0.3", "1");
  start(model, "b", "0.4", "-2");
  start(model, "c", "0.1", "3");
  model.outputs = {coordinateOutput("a"), coordinateOutput("b"), coordinateOutput("c"), speedOutput("a")};
  expectSameResponses(model, Eigen::MatrixXd(0, 1), 1e-7);
}

TEST(Lanes, LineariseExactly) {
  ModelSpec model = makeTwoBeam();
  const Eigen::MatrixXd points = makeTwoBeamPoints(5);
  const Eigen::MatrixXd lanes = runBy(Engine::kLanes, model, Eigen::VectorXd(), points, 2);
  const Eigen::MatrixXd simbody = runBy(Engine::kSimbody, model, Eigen::VectorXd(), points, 2);
  EXPECT_LT((lanes - simbody).cwiseAbs().maxCoeff(), 1e-7 * simbody.cwiseAbs().maxCoeff());
}

TEST(Lanes, GiveTheBitsOfASampleInAnyCompany) {
  ModelSpec model = makeTwoBeam();
  model.simulation.max_steps = 2000;
  const MultibodySimulator simulator(model, makeTwoBeamTimes());
  ASSERT_EQ(simulator.getEngine(), "lanes");
  const Eigen::MatrixXd points = makeTwoBeamPoints(21);
  const Trajectories reference = generateSamples(simulator, points, {1, 1, {}});
  const Trajectories reversed = generateSamples(simulator, points.rowwise().reverse(), {2, 5, {}});
  EXPECT_EQ(reversed.responses.rowwise().reverse(), reference.responses);
  Eigen::MatrixXd with_failures = points;
  with_failures(0, 3) = std::numeric_limits<double>::quiet_NaN();
  with_failures(2, 4) = -1e9;  // grows without bound
  const Trajectories beside = generateSamples(simulator, with_failures, {3, 64, {}});
  for (int j = 0; j < 21; ++j) {
    const bool failed = j == 3 || j == 4;
    EXPECT_EQ(beside.statuses[j].ok, !failed) << beside.statuses[j].reason;
    EXPECT_TRUE(failed || beside.responses.col(j) == reference.responses.col(j)) << j;
  }
}

TEST(Lanes, TryWhatIsStiffOnceMoreImplicitly) {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("c", 1.0, 1e7)};
  model.system.bodies = {body("block", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.system.elements.get<Spring>() = {{name("x"), ex("1"), ex("0")}};
  model.system.elements.get<Damper>() = {{name("x"), ex("c")}};
  start(model, "x", "1");
  model.outputs = {coordinateOutput("x")};
  model.simulation.relative_tolerance = 1e-6;
  model.simulation.absolute_tolerance = 1e-8;
  model.simulation.max_steps = 2000;
  MultibodySimulator simulator(model, Eigen::VectorXd::Constant(1, 2.0));
  ASSERT_EQ(simulator.getEngine(), "lanes");
  Eigen::MatrixXd points(1, 2), responses(1, 2);
  points << 3.0, 1e6;
  std::vector<SampleStatus> statuses(2);
  simulator.simulate(points, responses, statuses.data());
  EXPECT_TRUE(statuses[0].ok && !statuses[0].stiff_retry);
  EXPECT_TRUE(statuses[1].ok && statuses[1].stiff_retry) << statuses[1].reason;
  EXPECT_NEAR(responses(0, 1), std::exp(-2.0 / 1e6), 1e-4);  // creeps with k / c
}

/// A block of 1 kg that a spring pulls back slowly through a damper: rates c / m and k / c, a million to one.
ModelSpec makeStiff() {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("k", 0.5e6, 1.5e6), parameter("c", 0.8e6, 1.2e6)};
  model.system.bodies = {body("block", "1", kOrigin, kOrigin, joint(JointType::kSlider, {"x"}))};
  model.system.elements.get<Spring>() = {{name("x"), ex("k"), ex("0")}};
  model.system.elements.get<Damper>() = {{name("x"), ex("c")}};
  start(model, "x", "1");
  model.outputs = {coordinateOutput("x")};
  model.simulation.max_steps = 5000;
  return model;
}

/// exp(-k t / c) and its derivatives, to the millionth that the fast rate takes.
Eigen::MatrixXd calcCreep(const Eigen::VectorXd& times, double k, double c) {
  Eigen::MatrixXd creep(times.size(), 3);
  creep.col(0) = (-k / c * times.array()).exp();
  creep.col(1) = -times.array() / c * creep.col(0).array();
  creep.col(2) = k / (c * c) * times.array() * creep.col(0).array();
  return creep;
}

TEST(LanesDerivatives, OfWhatIsStiffAreDifferencesOfImplicitSolutions) {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(9, 0.0, 2.0);
  MultibodySimulator simulator(makeStiff(), times);
  ASSERT_TRUE(simulator.hasDerivatives());
  Eigen::MatrixXd points(2, 2), responses(9, 2), derivatives;
  points << 1e6, 1.5e6, 0.9e6, 0.8e6;  // inside and in a corner of the box
  std::vector<SampleStatus> statuses(2);
  simulator.simulateWithDerivatives(points, responses, derivatives, statuses.data());
  for (int j = 0; j < 2; ++j) {
    ASSERT_TRUE(statuses[j].ok && statuses[j].stiff_retry) << statuses[j].reason;
    const Eigen::MatrixXd expected = calcCreep(times, points(0, j), points(1, j));
    EXPECT_LT((responses.col(j) - expected.col(0)).cwiseAbs().maxCoeff(), 1e-5);
    const Eigen::MatrixXd slopes = derivatives.middleCols(2 * j, 2);
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT((slopes.col(k) - expected.col(1 + k)).cwiseAbs().maxCoeff(),
                1e-4 * expected.col(1 + k).cwiseAbs().maxCoeff());
    }
  }
}

TEST(LanesDerivatives, FailWithBothReasonsWhereTheStiffRetryFails) {
  ModelSpec model = makeStiff();
  model.simulation.max_steps = 10;
  MultibodySimulator simulator(model, Eigen::VectorXd::Constant(1, 2.0));
  Eigen::MatrixXd response(1, 1), derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(Eigen::Vector2d(1e6, 1e6), response, derivatives, &status);
  EXPECT_FALSE(status.ok);
  EXPECT_TRUE(status.stiff_retry);
  EXPECT_NE(status.reason.find("by Radau IIA: step limit"), std::string::npos) << status.reason;
  EXPECT_TRUE(std::isnan(response(0, 0)));
}

/// Derivatives at a point against central differences of tight simulations, 1e-4 of the bounds' width apart.
void expectDerivatives(ModelSpec model, const Eigen::VectorXd& point, int modes = 0) {
  model.simulation.relative_tolerance = 1e-10;
  model.simulation.absolute_tolerance = 1e-12;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(16, 0.0, model.simulation.duration);
  MultibodySimulator simulator(model, times, modes);
  ASSERT_TRUE(simulator.hasDerivatives());
  const Eigen::Index rows = simulator.getLayout().getRowCount();
  Eigen::MatrixXd response(rows, 1), derivatives;
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, derivatives, &status);
  ASSERT_TRUE(status.ok) << status.reason;
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  for (Eigen::Index k = 0; k < point.size(); ++k) {
    const double step = 1e-4 * (sampled[k].bounds.upper - sampled[k].bounds.lower);
    Eigen::MatrixXd points = point.replicate(1, 2), responses(rows, 2);
    points(k, 0) -= step;
    points(k, 1) += step;
    std::vector<SampleStatus> statuses(2);
    simulator.simulate(points, responses, statuses.data());
    const Eigen::VectorXd expected = (responses.col(1) - responses.col(0)) / (2.0 * step);
    EXPECT_LT((derivatives.col(k) - expected).cwiseAbs().maxCoeff(),
              1e-5 * (1e-3 + expected.cwiseAbs().maxCoeff()))
        << sampled[k].name.text;
  }
  expectFirstHeld(model, times, modes, point, derivatives);
}

TEST(LanesDerivatives, AreThoseOfTheTwoBeamsWithTheirModes) {
  expectDerivatives(makeTwoBeam(), makeTwoBeamPoints(1).col(0), 2);
}

TEST(LanesDerivatives, FollowTheSamplesOwnEquilibrium) {
  ModelSpec model = makeTwoBeam();
  model.initial.equilibrium->at = EquilibriumAt::kSample;
  model.parameters.push_back(parameter("tilt", -0.5, 0.5));
  model.system.gravity = ex3("0", "tilt", "-9.81");
  Eigen::VectorXd point(5);
  point << makeTwoBeamPoints(1).col(0), 0.2;
  expectDerivatives(model, point);
}

TEST(LanesDerivatives, FollowEventsThatMoveAndEveryExcitation) {
  for (const auto& [what, signal] : makeSignals()) {
    SCOPED_TRACE(what);
    ModelSpec model = makeDriven();
    model.excitation = {signal};
    // no output time at an event: there the response has a kink in t0
    expectDerivatives(model, Eigen::Vector3d(1.37, 0.517, 0.31));
  }
}

TEST(LanesDerivatives, HoldForNuisanceParametersAndInputsInTheStart) {
  ModelSpec model = makeDriven();
  model.excitation = {pulse("u", "lift", "t0", "1.5")};
  model.nuisance = {parameter("x0", -0.1, 0.1)};
  model.inputs = {parameter("load", 1.0, 2.0)};
  model.constants = {constant("lift", "a * load + 1")};
  start(model, "x", "x0", "load / 10");
  Eigen::VectorXd point(5);
  point << 1.5, 0.517, 0.3, 0.05, 1.4;
  expectDerivatives(model, point);
}

class LanesDerivativesOfEveryJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(LanesDerivativesOfEveryJoint, AreThoseOfDifferences) {
  ModelSpec model = makeTree(GetParam());
  addAllOutputs(model);
  model.simulation.duration = 0.3;
  model.parameters = {parameter("k", 5.0, 9.0), parameter("weight", 0.2, 0.4), parameter("tilt", 0.2, 0.4)};
  model.system.elements.get<Spring>()[0].stiffness = ex("k");
  model.system.bodies[2].mass = ex("weight");
  model.system.bodies[1].joint.in_parent.orientation[0] = ex("tilt");
  expectDerivatives(model, Eigen::Vector3d(7.0, 0.3, 0.31));
}

INSTANTIATE_TEST_SUITE_P(AllTypes, LanesDerivativesOfEveryJoint, ::testing::ValuesIn(listJoints()));

std::string getEngine(const ModelSpec& model) {
  return MultibodySimulator(model, Eigen::VectorXd::Constant(1, 1.0)).getEngine();
}

TEST(Lanes, AreTheEngineUnlessSomethingForbidsIt) {
  ModelSpec model = makeDriven();
  model.excitation = {pulse("u", "a", "t0", "1.5")};
  EXPECT_EQ(getEngine(model), "lanes");
  model.simulation.engine = Engine::kSimbody;
  EXPECT_EQ(getEngine(model), "simbody: simulation.engine asks for it");
}

#if defined(__AVX512F__)
TEST(Lanes, AreWhatANativeBuildHasOfPortableSamples) {
  ModelSpec model = makeDriven();
  model.excitation = {pulse("u", "a", "t0", "1.5")};
  model.simulation.portable = true;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(3, 0.0, model.simulation.duration);
  EXPECT_NO_THROW(MultibodySimulator(model, times, 0));
  EXPECT_THROW(MultibodySimulator(model, times, 1), ExperimentError);
  ModelSpec at_rest = model;
  at_rest.initial.equilibrium = EquilibriumSpec{};
  EXPECT_THROW(MultibodySimulator(at_rest, times, 0), ExperimentError);
  model.simulation.engine = Engine::kSimbody;
  EXPECT_THROW(MultibodySimulator(model, times, 0), ExperimentError);
}
#endif

TEST(Lanes, AreComparedWithSimbodyBeforeTheySimulate) {
  ModelSpec model = makeDriven();
  model.excitation = {pulse("u", "a", "t0", "1.5")};
  ModelSpec other = model;
  other.system.elements.get<ForceLaw>().push_back(law("x", "0.5 && 1.5"));
  ModelContext context(model);
  const std::unique_ptr<SimbodyModel> simbody = makeSimbodyModel(model);
  const auto compare = [&](const ModelSpec& recorded) {
    return compareWithSimbody(context, *simbody, compileModel(recordModel(recorded, context.names)));
  };
  EXPECT_EQ(compare(model), "");
  EXPECT_EQ(compare(other).rfind("acceleration of 'x' is ", 0), 0u);
}

TEST(TrustedModel, MovesAsOneThatSimbodyHasChecked) {
  const ModelSpec model = makeTwoBeam();  // starts from the equilibrium at the centre of the box
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(20, 0.05, 1.0);
  const Eigen::MatrixXd points = makeTwoBeamPoints(4);
  MultibodySimulator checked(model, times), trusted(model, times, 0, ModelCheck::kTrusted);
  ASSERT_EQ(trusted.getEngine(), "lanes");
  Eigen::MatrixXd expected(checked.getLayout().getRowCount(), points.cols()), responses = expected;
  std::vector<SampleStatus> statuses(points.cols());
  checked.simulate(points, expected, statuses.data());
  trusted.simulate(points, responses, statuses.data());
  EXPECT_LT((responses - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace twinmap::testing
