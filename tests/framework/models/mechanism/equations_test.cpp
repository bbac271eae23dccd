// The equations of motion over a scalar against Simbody, at arbitrary states of arbitrary trees.

#include <random>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/outputs.hpp"
#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"
#include "tests/framework/models/mechanism/random_state.hpp"
#include "tests/framework/models/mechanism/random_trees.hpp"
#include "tests/framework/models/mechanism/two_beam.hpp"

namespace twinmap::testing {
namespace {

using equations::ModelMotion;
using equations::ModelState;
using equations::SystemValues;

/// Simbody's and our own view of a model at one parameter point and one state.
class BothViews {
 public:
  BothViews(const ModelSpec& model, const Eigen::VectorXd& point) : model_(model), context_(model) {
    context_.numbers.update(point);
    system_.emplace(context_, true);
    values_ = context_.numbers.getValues();
    system_values_ = equations::calcSystemValues(model.system, context_.names, values_);
    simbody_ = system_->getTree().getDefaultState();
  }

  void setState(int seed, double t) {
    const InitialState random = makeRandomState(context_, seed);
    twinmap::setState(*system_, random, simbody_);
    simbody_.setTime(t);
    context_.excitation.mute();
    context_.excitation.beginPhase(t);
    own_.time = t;
    own_.coordinates.assign(random.coordinates.begin(), random.coordinates.end());
    const std::vector<double> rates(random.speeds.begin(), random.speeds.end());
    own_.speeds = equations::calcSpeeds(system_values_, own_.coordinates, rates);
    own_.signals.resize(model_.excitation.size());
    context_.excitation.calcValues(t, own_.signals);
    motion_ = equations::calcModelMotion(model_, context_.names, values_, system_values_, own_);
  }

  /// Each coordinate's speed and acceleration by Simbody's own solver, in our order.
  std::pair<std::vector<double>, std::vector<double>> calcBySimbody() {
    system_->getTree().getSystem().realize(simbody_, SimTK::Stage::Acceleration);
    std::vector<double> speeds, accelerations;
    for (const BodyTree::Slot& slot : system_->getTree().getSlots()) {
      speeds.push_back(simbody_.getU()[slot.u]);
      accelerations.push_back(simbody_.getUDot()[slot.u]);
    }
    return {speeds, accelerations};
  }

  std::vector<double> calcOutputsBySimbody() {
    const Outputs outputs(model_.outputs, context_.names, context_.numbers);
    std::vector<double> values(model_.outputs.size());
    outputs.calc(*system_, simbody_, own_.time, values.data(), 1);
    return values;
  }

  std::vector<double> calcOutputs() {
    std::vector<double> values;
    for (const OutputSpec& output : model_.outputs) {
      values.push_back(equations::calcOutput(output, context_.names, values_, system_values_, own_, motion_));
    }
    return values;
  }

  const ModelState<double>& getState() const { return own_; }
  const ModelMotion<double>& getMotion() const { return motion_; }

 private:
  const ModelSpec& model_;
  SimbodyContext context_;
  std::optional<LoadedSystem> system_;
  SimTK::State simbody_;
  NamedValues<double> values_;
  SystemValues<double> system_values_;
  ModelState<double> own_;
  ModelMotion<double> motion_;
};

void expectNear(const std::vector<double>& values, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(values.size(), expected.size());
  double largest = 0.0;
  for (const double value : expected) {
    largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], tolerance * largest) << i;
  }
}

void expectAgreement(const ModelSpec& model, const Eigen::VectorXd& point = Eigen::VectorXd()) {
  BothViews views(model, point);
  for (int seed = 0; seed < 10; ++seed) {
    views.setState(seed, 0.07 * seed);
    const auto [speeds, accelerations] = views.calcBySimbody();
    expectNear(views.getState().speeds, speeds, 1e-14);
    expectNear(views.getMotion().accelerations, accelerations, 1e-12);
    expectNear(views.calcOutputs(), views.calcOutputsBySimbody(), 1e-12);
    for (const double pivot : views.getMotion().pivots) {
      EXPECT_GT(pivot, 0.0);
    }
  }
}

class EquationsOfEveryJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(EquationsOfEveryJoint, AccelerateAndMeasureAsSimbodySays) {
  ModelSpec model = makeTree(GetParam());
  addAllOutputs(model);
  expectAgreement(model);
}

TEST_P(EquationsOfEveryJoint, HoldInBranchesOfTheSameJoint) {
  expectAgreement(makeBranches(GetParam()));
}

TEST_P(EquationsOfEveryJoint, KnowTheForceOfGravityOnCoordinates) {
  ModelSpec model = makeTree(GetParam());
  for (const BodySpec& body : model.system.bodies) {
    for (std::size_t i = 0; i < body.joint.coordinates.size(); ++i) {
      const std::string name = body.joint.coordinates[i].text;
      if (getJointCoordinates(body.joint.type)[i].takes_forces) {
        model.system.elements.get<ForceLaw>().push_back({{name, {}}, ex("-0.7*" + name + "_gravity")});
      }
    }
  }
  expectAgreement(model);
}

INSTANTIATE_TEST_SUITE_P(AllTypes, EquationsOfEveryJoint, ::testing::ValuesIn(listJoints()));

TEST(Equations, HoldForBushings) {
  expectAgreement(makeBushedBodies());
}

TEST(Equations, HoldForTheTwoBeams) {
  ModelSpec model = makeTwoBeam();
  for (int i = 0; i < 5; ++i) {
    expectAgreement(model, makeTwoBeamPoints(5).col(i));
  }
}

TEST(Equations, GiveCoincidentPointsNoForce) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {body("block", "2", ex3("0", "0", "0"), ex3("0", "0", "0"),
                              joint(JointType::kTranslation, {"x", "y", "z"}))};
  model.system.elements.get<TwoPointSpring>() = {
      {station("ground", ex3("0.5", "0", "0")), station("block", ex3("0.5", "0", "0")), ex("5"), ex("0.1")}};
  SimbodyContext context(model);
  const NamedValues<double> none;
  const SystemValues<double> values = equations::calcSystemValues(model.system, context.names, none);
  const ModelState<double> rest{0.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {}, {}, {}};
  EXPECT_EQ(equations::calcModelMotion(model, context.names, none, values, rest).accelerations,
            std::vector<double>(3, 0.0));
}

TEST(Equations, SeeASingularMassMatrix) {
  ModelSpec model = makeModel(1.0);
  model.system.bodies = {
      body("pointer", "1", ex3("0", "0", "0"), ex3("0", "0", "0"), joint(JointType::kPin, {"turn"}))};
  SimbodyContext context(model);
  const NamedValues<double> none;
  const SystemValues<double> values = equations::calcSystemValues(model.system, context.names, none);
  const ModelState<double> rest{0.0, {0.3}, {0.0}, {}, {}, {}};
  EXPECT_FALSE(equations::calcModelMotion(model, context.names, none, values, rest).pivots[0] > 0.0);
}

}  // namespace
}  // namespace twinmap::testing
