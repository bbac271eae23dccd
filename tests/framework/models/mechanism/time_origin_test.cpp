// A simulation that begins within the excitation's time is the rest of one that begins at 0.
#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

constexpr double kDuration = 2.0;

/// Driven by a held and a cubic table, a pulse, a sine and a force that names the time.
ModelSpec makeDriven(double duration) {
  ModelSpec model = makeModel(duration);
  const JointSpec slider = joint(JointType::kSlider, ex3("1", "0", "0"), {"y"});
  model.system.bodies = {body("mass", "2", ex3("0", "0", "0"), ex3("1", "1", "1"), slider)};
  model.system.elements.get<Spring>() = {{name("y"), ex("k"), ex("0")}};
  model.system.elements.get<ForceLaw>() = {law("y", "u + w + 0.3 * t")};
  model.parameters = {parameter("k", 20.0, 40.0)};
  model.nuisance = {parameter("y_0", -1.0, 1.0), parameter("v_0", -5.0, 5.0)};
  model.inputs = {parameter("begin", 0.0, kDuration)};
  start(model, "y", "y_0", "v_0");
  SignalSpec held;
  held.name = name("u");
  held.unit = "N";
  TableSpec steps;
  for (int i = 0; i <= 20; ++i) {
    steps.times.push_back(0.1 * i);
    steps.values.push_back(std::sin(1.7 * i));
  }
  steps.interpolation = TableInterpolation::kHold;
  held.tables = {steps};
  SignalSpec smooth = held;
  smooth.name = name("w");
  smooth.tables[0].interpolation = TableInterpolation::kCubic;
  smooth.pulses = {{ex("2"), ex("0.35"), ex("1.25")}};
  smooth.sines = {{ex("1"), ex("0.8"), ex("0"), ex("0.2")}};
  model.excitation = {held, smooth};
  model.outputs = {coordinateOutput("y"), speedOutput("y")};
  return model;
}

struct Motion {
  Eigen::MatrixXd outputs, derivatives;  ///< derivatives: of all outputs, a column a parameter
};

Motion run(const ModelSpec& model, const Eigen::VectorXd& times, const Eigen::VectorXd& point) {
  MultibodySimulator simulator(model, times);
  Eigen::MatrixXd response(2 * times.size(), 1);
  Motion found;
  SampleStatus status;
  simulator.simulateWithDerivatives(point, response, found.derivatives, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  found.outputs = response.reshaped(times.size(), 2);
  return found;
}

// 0.35 and 1.25 s are switches of the pulse, 0.9 s is a time of the tables, up to rounding on either side.
TEST(TimeOrigin, GoesOnWhereTheWholeSimulationIs) {
  const Eigen::VectorXd whole_times = Eigen::VectorXd::LinSpaced(41, 0.0, kDuration);
  const Eigen::Vector4d from_start(30.0, 0.3, -0.2, 0.0);
  const Motion whole = run(makeDriven(kDuration), whole_times, from_start);
  for (const int first : {0, 7, 9, 18, 25}) {
    const double begin = whole_times[first], duration = 0.5;
    ModelSpec model = makeDriven(duration);
    model.time_origin = name("begin");
    const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(11, 0.0, duration);
    const Eigen::Vector4d point(30.0, whole.outputs(first, 0), whole.outputs(first, 1), begin);
    const Motion part = run(model, times, point);
    EXPECT_LT((part.outputs - whole.outputs.middleRows(first, 11)).cwiseAbs().maxCoeff(), 1e-9) << begin;
    // d y / d k and d y / d (state) of the parts make that of the whole
    const Eigen::Index last = first + 10;
    const auto at = [&](const Motion& of, Eigen::Index row, Eigen::Index times_of, Eigen::Index output,
                        Eigen::Index parameter) {
      return of.derivatives(output * times_of + row, parameter);
    };
    const double chained = at(part, 10, 11, 0, 0) + at(part, 10, 11, 0, 1) * at(whole, first, 41, 0, 0) +
                           at(part, 10, 11, 0, 2) * at(whole, first, 41, 1, 0);
    EXPECT_NEAR(chained, at(whole, last, 41, 0, 0), 1e-9);
    EXPECT_EQ(part.derivatives.col(3).cwiseAbs().maxCoeff(), 0.0);  // no direction of its own
  }
}

TEST(TimeOrigin, IsEachSamplesOwn) {
  ModelSpec model = makeDriven(0.5);
  model.time_origin = name("begin");
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(6, 0.0, 0.5);
  MultibodySimulator simulator(model, times);
  Eigen::MatrixXd points(4, 9);
  for (int i = 0; i < 9; ++i) {
    points.col(i) << 30.0, 0.1, 0.0, 0.15 * i;
  }
  Eigen::MatrixXd together(12, 9), alone(12, 1);
  std::vector<SampleStatus> statuses(9);
  simulator.simulate(points, together, statuses.data());
  for (int i = 0; i < 9; ++i) {
    simulator.simulate(points.col(i), alone, statuses.data());
    EXPECT_EQ(alone, together.col(i)) << i;
  }
}

}  // namespace
}  // namespace twinmap::testing
