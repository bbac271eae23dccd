// Accelerations and bushings against Simbody's own, at arbitrary states of arbitrary trees.

#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "tests/framework/models/mechanism/random_state.hpp"
#include "tests/framework/models/mechanism/random_trees.hpp"

namespace twinmap::testing {
namespace {

class EveryJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(EveryJoint, AcceleratesAsSimbodySays) {
  const ModelSpec model = makeTree(GetParam());
  SimbodyContext context(model);
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
  SimbodyContext context(model);
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

INSTANTIATE_TEST_SUITE_P(AllTypes, EveryJoint, ::testing::ValuesIn(listJoints()));

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
  SimbodyContext context(model);
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
