// Each force element against Simbody's own force class for it: accelerations at random states of a branched
// tree, by the recorded equations and by the Simbody engine, which share the laws of our elements.

#include <memory>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/model_equations.hpp"
#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "tests/framework/models/mechanism/random_state.hpp"
#include "tests/framework/models/mechanism/random_trees.hpp"

namespace twinmap::testing {
namespace {

using SimTK::Force;
using SimTK::MobilizedBody;
using SimTK::MobilizerQIndex;
using SimTK::MobilizerUIndex;
using SimTK::Vec3;

/// Bodies of makeTree() by Simbody's index.
constexpr int kBase = 1, kTested = 2, kRider = 3, kBeside = 4;

/// What Simbody's own force classes are made with.
struct OwnForces {
  SimTK::GeneralForceSubsystem& forces;
  const BodyTree& tree;
  const MobilizedBody& at(int body) const { return tree.getBody(body); }
};

SimTK::Transform makeBushingFrame(const Vec3& point, const Vec3& angles) {
  SimTK::Rotation rotation;
  rotation.setRotationToBodyFixedXYZ(angles);
  return SimTK::Transform(rotation, point);
}

void expectNear(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  double largest = 0.0;
  for (const double value : expected) {
    largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], 1e-10 * largest) << i;
  }
}

/// Accelerations of one model in the order of its coordinates, by three ways.
class ThreeWays {
 public:
  /// `add` adds Simbody's forces, which must be those of the model.
  template <class Add>
  ThreeWays(const ModelSpec& model, Add add) : model_(model), context_(model) {
    context_.numbers.update(Eigen::VectorXd());
    engine_.emplace(context_, false);
    own_.emplace(model.system, context_.names, context_.numbers);
    forces_ = &own_->addForceSubsystem();
    add(OwnForces{*forces_, *own_});
    own_->realize();
    values_ = equations::calcSystemValues(model.system, context_.names, names_);
  }

  void setState(int seed) {
    state_ = engine_->getTree().getDefaultState();
    random_ = makeRandomState(context_, seed);
    twinmap::setState(*engine_, random_, state_);
  }

  std::vector<double> calcBySimbody() const {
    SimTK::State state = own_->getDefaultState();
    state.updQ() = state_.getQ();
    state.updU() = state_.getU();
    own_->getSystem().realize(state, SimTK::Stage::Acceleration);
    return reorder(state.getUDot());
  }
  std::vector<double> calcByEngine() { return reorder(engine_->calcUDot(state_, 0.0)); }
  std::vector<double> calcByEquations() const {
    equations::ModelState<double> state;
    state.coordinates.assign(random_.coordinates.begin(), random_.coordinates.end());
    const std::vector<double> rates(random_.speeds.begin(), random_.speeds.end());
    state.speeds = equations::calcSpeeds(values_, state.coordinates, rates);
    return equations::calcModelMotion(model_, context_.names, names_, values_, state).accelerations;
  }

 private:
  template <class Vector>
  std::vector<double> reorder(const Vector& udot) const {
    std::vector<double> ordered;
    for (const BodyTree::Slot& slot : engine_->getTree().getSlots()) {
      ordered.push_back(udot[slot.u]);
    }
    return ordered;
  }

  const ModelSpec& model_;
  SimbodyContext context_;
  NamedValues<double> names_;
  equations::SystemValues<double> values_;
  std::optional<LoadedSystem> engine_;
  std::optional<BodyTree> own_;
  SimTK::GeneralForceSubsystem* forces_;
  SimTK::State state_;
  InitialState random_;
};

class SimbodysOwnForces : public ::testing::TestWithParam<JointType> {
 protected:
  SimbodysOwnForces() {
    model_.system.elements = {};
    model_.system.gravity = kOrigin;
  }

  template <class Add>
  void expectSame(Add add) {
    ModelSpec bare = model_;
    bare.system.elements = {};
    bare.system.gravity = kOrigin;
    ThreeWays with(model_, add), without(bare, [](const OwnForces&) {});
    for (int seed = 0; seed < 20; ++seed) {
      with.setState(seed);
      without.setState(seed);
      const std::vector<double> expected = with.calcBySimbody();
      expectNear(with.calcByEngine(), expected);
      expectNear(with.calcByEquations(), expected);
      forces_act_ = forces_act_ || expected != without.calcBySimbody();
    }
    EXPECT_TRUE(forces_act_);
  }

  template <template <class> class Element>
  std::vector<Element<Expression>>& elements() {
    return model_.system.elements.get<Element>();
  }

  ModelSpec model_ = makeTree(GetParam());
  bool forces_act_ = false;
};

TEST_P(SimbodysOwnForces, Gravity) {
  model_.system.gravity = ex3("0.3", "-2", "-9.81");
  expectSame([](const OwnForces& own) {
    Force::UniformGravity(own.forces, own.tree.getMatter(), Vec3(0.3, -2.0, -9.81));
  });
}

TEST_P(SimbodysOwnForces, MobilityLinearSpringIsASpring) {
  elements<Spring>() = {{name("ride"), ex("7"), ex("0.1")}, {name("swing"), ex("3"), ex("-0.2")}};
  expectSame([](const OwnForces& own) {
    Force::MobilityLinearSpring(own.forces, own.at(kRider), MobilizerQIndex(0), 7.0, 0.1);
    Force::MobilityLinearSpring(own.forces, own.at(kBeside), MobilizerQIndex(0), 3.0, -0.2);
  });
}

TEST_P(SimbodysOwnForces, MobilityLinearDamperIsADamper) {
  elements<Damper>() = {{name("swing"), ex("0.3")}, {name("base_turn"), ex("2")}};
  expectSame([](const OwnForces& own) {
    Force::MobilityLinearDamper(own.forces, own.at(kBeside), MobilizerUIndex(0), 0.3);
    Force::MobilityLinearDamper(own.forces, own.at(kBase), MobilizerUIndex(0), 2.0);
  });
}

TEST_P(SimbodysOwnForces, TwoPointLinearSpringIsATwoPointSpring) {
  elements<TwoPointSpring>() = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("50"), ex("0.1")},
      {station("ground", ex3("1", "2", "0")), station("tested", ex3("0", "0", "0.3")), ex("8"), ex("2")}};
  expectSame([](const OwnForces& own) {
    Force::TwoPointLinearSpring(own.forces, own.at(kBeside), Vec3(0.1, 0.0, 0.0), own.at(kRider),
                                Vec3(0.0, 0.2, 0.0), 50.0, 0.1);
    Force::TwoPointLinearSpring(own.forces, own.at(0), Vec3(1.0, 2.0, 0.0), own.at(kTested),
                                Vec3(0.0, 0.0, 0.3), 8.0, 2.0);
  });
}

TEST_P(SimbodysOwnForces, TwoPointLinearDamperIsATwoPointDamper) {
  elements<TwoPointDamper>() = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("5")}};
  expectSame([](const OwnForces& own) {
    Force::TwoPointLinearDamper(own.forces, own.at(kBeside), Vec3(0.1, 0.0, 0.0), own.at(kRider),
                                Vec3(0.0, 0.2, 0.0), 5.0);
  });
}

TEST_P(SimbodysOwnForces, LinearBushingIsABushing) {
  Bushing<Expression> bushing;
  bushing.from = {name("tested"), {ex3("0.1", "0.2", "0.3"), ex3("0.3", "0.1", "-0.2")}};
  bushing.to = {name("beside"), {ex3("-0.2", "0.1", "0"), ex3("0.1", "0.2", "0.2")}};
  bushing.stiffness = {ex("1"), ex("2"), ex("3"), ex("40"), ex("50"), ex("60")};
  bushing.damping = {ex("0.1"), ex("0.2"), ex("0.3"), ex("4"), ex("5"), ex("6")};
  elements<Bushing>() = {bushing};
  expectSame([](const OwnForces& own) {
    Force::LinearBushing(own.forces, own.at(kTested),
                         makeBushingFrame(Vec3(0.1, 0.2, 0.3), Vec3(0.3, 0.1, -0.2)), own.at(kBeside),
                         makeBushingFrame(Vec3(-0.2, 0.1, 0.0), Vec3(0.1, 0.2, 0.2)),
                         SimTK::Vec6(1, 2, 3, 40, 50, 60), SimTK::Vec6(0.1, 0.2, 0.3, 4, 5, 6));
  });
}

TEST_P(SimbodysOwnForces, ConstantForceIsAnAppliedForce) {
  elements<AppliedForce>() = {
      {station("rider", ex3("0.1", "0", "0.2")), ex3("1", "-2", "3"), ForceFrame::kGround}};
  expectSame([](const OwnForces& own) {
    Force::ConstantForce(own.forces, own.at(kRider), Vec3(0.1, 0.0, 0.2), Vec3(1.0, -2.0, 3.0));
  });
}

TEST_P(SimbodysOwnForces, ConstantTorqueIsAnAppliedMoment) {
  elements<AppliedMoment>() = {{name("tested"), ex3("0.1", "-0.2", "0.3"), ForceFrame::kGround},
                               {name("beside"), ex3("1", "2", "3"), ForceFrame::kGround}};
  expectSame([](const OwnForces& own) {
    Force::ConstantTorque(own.forces, own.at(kTested), Vec3(0.1, -0.2, 0.3));
    Force::ConstantTorque(own.forces, own.at(kBeside), Vec3(1.0, 2.0, 3.0));
  });
}

TEST_P(SimbodysOwnForces, MobilityLinearStopIsAForceLaw) {
  // Simbody's stop: k x (1 + d x') for a penetration x, never pulling
  elements<ForceLaw>() = {{name("swing"), ex("-max(0, 400 * max(0, swing - 0.1) * (1 + 0.3 * swing_dot)) + "
                                             "max(0, 400 * max(0, -0.2 - swing) * (1 - 0.3 * swing_dot))")}};
  expectSame([](const OwnForces& own) {
    Force::MobilityLinearStop(own.forces, own.at(kBeside), MobilizerQIndex(0), 400.0, 0.3, -0.2, 0.1);
  });
}

INSTANTIATE_TEST_SUITE_P(TreesOf, SimbodysOwnForces,
                         ::testing::Values(JointType::kFree, JointType::kUniversal, JointType::kScrew,
                                           JointType::kBall));

}  // namespace
}  // namespace twinmap::testing
