// A mass of 2 kg that flies on without forces: y = y_0 + v_0 t.
#include "framework/experiment/model/elements/force_elements.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

ModelSpec makeFlight() {
  ModelSpec model = makeModel(2.0);
  const JointSpec slider = joint(JointType::kSlider, ex3("1", "0", "0"), {"y"});
  model.system.bodies = {body("mass", "2", ex3("0", "0", "0"), ex3("1", "1", "1"), slider)};
  model.parameters = {parameter("v_0", 1.0, 3.0)};
  model.nuisance = {parameter("bias", -1.0, 1.0), parameter("y_0", -1.0, 1.0)};
  model.inputs = {parameter("g", 0.5, 2.0)};
  model.constants = {constant("both", "y_0 + 0 * g")};
  start(model, "y", "both", "v_0");
  model.outputs = {coordinateOutput("y"), speedOutput("y")};
  return model;
}

const Eigen::Vector3d kTimes(0.5, 1.0, 2.0);

Eigen::VectorXd makePoint(double v_0, double bias, double y_0, double g) {
  return (Eigen::VectorXd(4) << v_0, bias, y_0, g).finished();
}

TEST(Sensors, MeasureGainTimesQuantityPlusOffset) {
  ModelSpec model = makeFlight();
  model.outputs[0].gain = ex("g");
  model.outputs[0].offset = ex("bias");
  model.outputs[1].offset = ex("2 * bias");
  const Eigen::MatrixXd measured = runModel(model, kTimes, makePoint(2.0, 0.25, -0.5, 1.5));
  for (Eigen::Index i = 0; i < kTimes.size(); ++i) {
    EXPECT_NEAR(measured(i, 0), 1.5 * (-0.5 + 2.0 * kTimes[i]) + 0.25, 1e-12);
    EXPECT_NEAR(measured(i, 1), 2.0 + 0.5, 1e-12);
  }
}

TEST(Sensors, AreIdealUnlessGiven) {
  ModelSpec model = makeFlight();
  const Eigen::VectorXd point = makePoint(2.0, 0.25, -0.5, 1.5);
  const Eigen::MatrixXd ideal = runModel(model, kTimes, point);
  EXPECT_NEAR(ideal(2, 0), 3.5, 1e-12);
  model.outputs[0].gain = ex("1");
  model.outputs[0].offset = ex("0");
  EXPECT_EQ(runModel(model, kTimes, point), ideal);
}

TEST(Sensors, WithoutAFiniteNumberFailTheSample) {
  ModelSpec model = makeFlight();
  model.outputs[0].gain = ex("1 / bias");
  EXPECT_EQ(getError(model), "at the centre of the bounds: output 'y': gain = inf must be finite");
}

TEST(Roles, TheEquilibriumOfTheBoxCentreIsThatOfAllSampledParameters) {
  ModelSpec model = makeFlight();
  model.system.elements.get<Spring>() = {{name("y"), ex("10"), ex("bias + g")}};
  model.initial = {};
  model.initial.equilibrium = EquilibriumSpec{};
  model.initial.equilibrium->parameters = {value("bias", "0.5")};
  model.system.elements.get<Spring>()[0].rest = ex("bias + g");
  const Eigen::MatrixXd measured = runModel(model, Eigen::VectorXd::Zero(1), makePoint(1.0, 0.0, 0.0, 1.0));
  EXPECT_NEAR(measured(0, 0), 0.5 + 1.25, 1e-9);
}

}  // namespace
}  // namespace twinmap::testing
