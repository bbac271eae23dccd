// Accelerations and bushings against Simbody's own, at arbitrary states of arbitrary trees.

#include <random>

#include "framework/multibody/initial_state.hpp"
#include "tests/framework/multibody/run_model.hpp"

namespace twinmap::testing {
namespace {

std::vector<std::string> makeNames(const std::string& prefix, JointType type) {
  std::vector<std::string> names;
  for (int i = 0; i < getCoordinateCount(type); ++i) {
    names.push_back(prefix + std::to_string(i));
  }
  return names;
}

/// Two branches on a pinned base: the joint under test carries a body that carries a slider; a pin beside it.
ModelSpec makeTree(JointType type) {
  ModelSpec model = makeModel(1.0);
  model.system.gravity = ex3("0.3", "-2", "-9.81");
  const Expression3 moments = ex3("0.02", "0.03", "0.04");
  JointSpec tested = joint(type, makeNames("q", type), "base");
  tested.in_parent.point = ex3("0.1", "0.2", "-0.3");
  tested.in_parent.orientation = ex3("0.3", "-0.2", "0.1");
  tested.in_body.point = ex3("-0.2", "0.05", "0.1");
  tested.in_body.orientation = ex3("-0.1", "0.4", "0.2");
  tested.pitch = ex("0.2");
  model.system.bodies = {
      body("base", "2", ex3("0.1", "0", "0.2"), moments,
           joint(JointType::kPin, ex3("1", "1", "0"), {"base_turn"})),
      body("tested", "0.5", ex3("0.1", "-0.2", "0.05"), moments, tested),
      body("rider", "0.3", ex3("0.2", "0.1", "0"), moments,
           joint(JointType::kSlider, ex3("0", "1", "1"), {"ride"}, "tested")),
      body("beside", "0.4", ex3("0", "0.3", "0.1"), moments, joint(JointType::kPin, {"swing"}, "base"))};
  model.system.bodies[1].inertia.products = ex3("0.001", "-0.002", "0.003");
  model.system.springs = {{name("ride"), ex("7"), ex("0.1")}};
  model.system.dampers = {{name("swing"), ex("0.3")}};
  model.system.two_point_springs = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("5"), ex("0.1")}};
  model.system.two_point_dampers = {
      {station("beside", ex3("0.1", "0", "0")), station("rider", ex3("0", "0.2", "0")), ex("2")}};
  model.system.applied_forces = {
      {station("rider", ex3("0.1", "0", "0.2")), ex3("t", "2 * ride", "swing_dot"), ForceFrame::kBody}};
  return model;
}

InitialState makeRandomState(const ModelContext& context, int seed) {
  std::mt19937 generator(seed);
  const auto draw = [&generator] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; };
  const Eigen::Index n = static_cast<Eigen::Index>(context.names.getCoordinateNames().size());
  return {Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return draw(); }),
          Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return 4.0 * draw(); })};
}

class EveryJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(EveryJoint, AcceleratesAsSimbodySays) {
  const ModelSpec model = makeTree(GetParam());
  ModelContext context(model);
  context.numbers.update(Eigen::VectorXd());
  LoadedSystem system(context, true);
  SimTK::State state = system.getTree().getDefaultState();
  for (int seed = 0; seed < 5; ++seed) {
    setState(system, makeRandomState(context, seed), state);
    state.setTime(0.7);
    system.getTree().getSystem().realize(state, SimTK::Stage::Acceleration);
    const SimTK::Vector expected = state.getUDot();
    const Eigen::VectorXd udot = system.calcUDot(state, 0.7);
    for (int i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(udot[i], expected[i], 1e-11 * expected.normInf());
    }
  }
}

TEST_P(EveryJoint, SpeedIsTheDerivativeOfTheCoordinateWhereForcesAreAllowed) {
  const ModelSpec model = makeTree(GetParam());
  ModelContext context(model);
  context.numbers.update(Eigen::VectorXd());
  LoadedSystem system(context, false);
  SimTK::State state = system.getTree().getDefaultState();
  const InitialState random = makeRandomState(context, 3);
  setState(system, random, state);
  const std::vector<CoordinatePlace>& places = context.names.getCoordinates();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const BodyTree::Slot slot = system.getTree().getSlots()[i];
    EXPECT_NEAR(state.getQDot()[slot.q], random.speeds[i], 1e-12);
    const bool same = std::abs(state.getU()[slot.u] - state.getQDot()[slot.q]) < 1e-12;
    EXPECT_EQ(same, places[i].traits.takes_forces) << context.names.getCoordinateNames()[i];
  }
}

INSTANTIATE_TEST_SUITE_P(AllTypes, EveryJoint,
                         ::testing::Values(JointType::kWeld, JointType::kSlider, JointType::kPin,
                                           JointType::kScrew, JointType::kCylinder, JointType::kUniversal,
                                           JointType::kBendStretch, JointType::kPlanar,
                                           JointType::kTranslation, JointType::kGimbal, JointType::kBall,
                                           JointType::kBushing, JointType::kFree));

/// Two free bodies joined by a bushing.
ModelSpec makeBushedBodies() {
  ModelSpec model = makeModel(1.0);
  const Expression3 moments = ex3("0.02", "0.03", "0.04");
  model.system.bodies = {body("one", "2", ex3("0.1", "0", "0.2"), moments,
                              joint(JointType::kFree, makeNames("p", JointType::kFree))),
                         body("two", "1", ex3("0", "0.2", "0"), moments,
                              joint(JointType::kFree, makeNames("q", JointType::kFree)))};
  BushingSpec bushing;
  bushing.from = {name("one"), {ex3("0.1", "0.2", "0.3"), ex3("0.3", "0.1", "-0.2")}};
  bushing.to = {name("two"), {ex3("-0.2", "0.1", "0"), ex3("0.1", "0.2", "0.2")}};
  bushing.stiffness = {ex("1"), ex("2"), ex("3"), ex("40"), ex("50"), ex("60")};
  bushing.damping = {ex("0.1"), ex("0.2"), ex("0.3"), ex("4"), ex("5"), ex("6")};
  model.system.bushings = {bushing};
  return model;
}

SimTK::Transform makeFrame(const SimTK::Vec3& point, const SimTK::Vec3& angles) {
  SimTK::Rotation rotation;
  rotation.setRotationToBodyFixedXYZ(angles);
  return SimTK::Transform(rotation, point);
}

/// Forces of Simbody's own element for makeBushedBodies() at the same coordinates and speeds.
SimTK::Vector_<SimTK::SpatialVec> calcLinearBushing(const SimTK::State& at) {
  using SimTK::Vec3;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter(system);
  SimTK::GeneralForceSubsystem forces(system);
  const SimTK::Body::Rigid unit(SimTK::MassProperties(1.0, Vec3(0.0), SimTK::Inertia(1.0)));
  const SimTK::MobilizedBody::Free one(matter.updGround(), unit), two(matter.updGround(), unit);
  const SimTK::Transform from = makeFrame(Vec3(0.1, 0.2, 0.3), Vec3(0.3, 0.1, -0.2));
  const SimTK::Transform to = makeFrame(Vec3(-0.2, 0.1, 0.0), Vec3(0.1, 0.2, 0.2));
  SimTK::Force::LinearBushing(forces, one, from, two, to, SimTK::Vec6(1, 2, 3, 40, 50, 60),
                              SimTK::Vec6(0.1, 0.2, 0.3, 4, 5, 6));
  SimTK::State state = system.realizeTopology();
  matter.setUseEulerAngles(state, true);
  system.realizeModel(state);
  state.updQ() = at.getQ();
  state.updU() = at.getU();
  system.realize(state, SimTK::Stage::Dynamics);
  return system.getRigidBodyForces(state, SimTK::Stage::Dynamics);
}

TEST(Bushing, AgreesWithSimbodysLinearBushing) {
  const ModelSpec model = makeBushedBodies();
  ModelContext context(model);
  context.numbers.update(Eigen::VectorXd());
  LoadedSystem system(context, false);
  SimTK::State state = system.getTree().getDefaultState();
  setState(system, makeRandomState(context, 11), state);
  const SystemForces own = system.calcForces(state, 0.0);
  const SimTK::Vector_<SimTK::SpatialVec> expected = calcLinearBushing(state);
  for (int i = 1; i <= 2; ++i) {
    EXPECT_LT((own.on_bodies[i][0] - expected[i][0]).norm(), 1e-12 * expected[i][0].norm());
    EXPECT_LT((own.on_bodies[i][1] - expected[i][1]).norm(), 1e-12 * expected[i][1].norm());
  }
}

}  // namespace
}  // namespace twinmap::testing
