// Curves in the equations of motion: by both engines, and with exact derivatives with respect to their knots.

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/models/mechanism/run_model.hpp"

namespace twinmap::testing {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rotor that is driven by motor(u) against friction, u a sine.
ModelSpec makeDriven(bool monotone) {
  ModelSpec model = makeModel(2.0);
  model.parameters = {parameter("d1", 0.1, 0.5), parameter("d2", 0.1, 0.5), parameter("J", 0.05, 0.1)};
  JointSpec pin = joint(JointType::kPin, {"q"});
  BodySpec rotor = body("rotor", "1", kOrigin, kOrigin, pin);
  rotor.inertia = {};
  rotor.inertia.about_axis = ex("J");
  model.system.bodies = {rotor};
  SignalSpec drive;
  drive.name = name("u");
  drive.sines.emplace_back();
  drive.sines[0].amplitude = ex("6");
  drive.sines[0].frequency = ex("0.7");
  model.excitation = {drive};
  CurveSpec motor;
  motor.name = name("motor");
  motor.over = name("u");
  motor.range = {-5.0, 5.0, {}};
  motor.monotone = monotone;
  motor.values = {ex("-d1 - d2"), ex("-d1"), ex("0.01"), ex("d2"), ex("d2 + d1")};
  model.system.curves = {motor};
  model.system.elements.get<ForceLaw>() = {law("q", "motor(u) - 0.1 * q_dot")};
  OutputSpec torque;
  torque.name = name("torque");
  torque.expression = ex("motor(u)");
  torque.unit = "N m";
  model.outputs = {coordinateOutput("q"), torque};
  return model;
}

TEST(Curves, HaveExactDerivativesWithRespectToTheirKnots) {
  for (const bool monotone : {false, true}) {
    ModelSpec model = makeDriven(monotone);
    model.simulation.engine = Engine::kLanes;     // an error unless Simbody's is the same
    model.simulation.relative_tolerance = 1e-13;  // knots are passed with less accuracy than steps are taken
    model.simulation.absolute_tolerance = 1e-15;
    const VectorXd times = VectorXd::LinSpaced(9, 0.0, 2.0);
    MultibodySimulator simulator(model, times);
    const Eigen::Vector3d point(0.2, 0.4, 0.07);
    MatrixXd response(18, 1), derivatives, around(18, 2), points(3, 2);
    SampleStatus status, statuses[2];
    simulator.simulateWithDerivatives(point, response, derivatives, &status);
    ASSERT_TRUE(status.ok) << status.reason;
    for (Index k = 0; k < 3; ++k) {
      points.col(0) = points.col(1) = point;
      points(k, 0) += 1e-4;
      points(k, 1) -= 1e-4;
      simulator.simulate(points, around, statuses);
      const VectorXd difference = (around.col(0) - around.col(1)) / 2e-4;
      EXPECT_LT((derivatives.col(k) - difference).cwiseAbs().maxCoeff(),
                1e-5 * difference.cwiseAbs().maxCoeff());
    }
    model.simulation.engine = Engine::kSimbody;
    model.simulation.relative_tolerance = 1e-9;
    MatrixXd by_simbody(18, 1);
    MultibodySimulator(model, times).simulate(point, by_simbody, &status);
    EXPECT_LT((by_simbody - response).cwiseAbs().maxCoeff(), 1e-6);  // of some radians, past 16 knots
  }
}

TEST(Curves, MustHaveFiniteValues) {
  ModelSpec model = makeDriven(false);
  model.system.curves[0].values[2] = ex("1 / (d1 - 0.3)");
  EXPECT_NE(getError(model).find("curve 'motor': values"), std::string::npos) << getError(model);
}

}  // namespace
}  // namespace twinmap::testing
