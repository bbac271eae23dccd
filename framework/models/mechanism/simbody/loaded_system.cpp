#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {
namespace {

template <class Column>
algebra::Vec3<double> toVector(const Column& v) {
  return {v[0], v[1], v[2]};
}

SimTK::Vec3 toVec3(const algebra::Vec3<double>& v) {
  return SimTK::Vec3(v.x, v.y, v.z);
}

/// Shows the forces of a loaded system to Simbody's own integrators, and keeps its states of first order in
/// Simbody's z.
class ForceAdapter : public SimTK::Force::Custom::Implementation {
 public:
  ForceAdapter(LoadedSystem& system, const SimTK::GeneralForceSubsystem& subsystem)
      : system_(system), subsystem_(subsystem) {}

  void realizeTopology(SimTK::State& state) const override {
    if (system_.countStates() > 0) {
      subsystem_.allocateZ(state, SimTK::Vector(system_.countStates(), 0.0));
    }
  }

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector& mobility_forces) const override {
    const SystemForces& forces = system_.calcForces(state, state.getTime());
    for (std::size_t i = 0; i < forces.on_bodies.size(); ++i) {
      body_forces[static_cast<int>(i)] += forces.on_bodies[i];
    }
    for (std::size_t i = 0; i < forces.on_speeds.size(); ++i) {
      mobility_forces[static_cast<int>(i)] += forces.on_speeds[i];
    }
  }
  void realizeAcceleration(const SimTK::State& state) const override {
    if (system_.countStates() > 0) {
      system_.calcForces(state, state.getTime());
      std::copy(system_.getStateRates().begin(), system_.getStateRates().end(),
                state.updZDot().updContiguousScalarData());
    }
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  LoadedSystem& system_;
  const SimTK::GeneralForceSubsystem& subsystem_;
};

}  // namespace

LoadedSystem::LoadedSystem(SimbodyContext& context, bool for_simbody)
    : context_(context),
      tree_(context.model.system, context.names, context.numbers),
      numbers_(calcLoadNumbers(context.model.system, context.names, context.numbers)),
      coordinates_(context.names.getCoordinateNames().size()),
      rates_(coordinates_.size()),
      states_(context.names.getStateNames().size()),
      signals_(context.excitation.getSignalCount(), 0.0),
      signal_rates_(context.expressions.getSignalRateCount()) {
  context.expressions.setNumbers(context.numbers.getValues());
  context.excitation.update(context.numbers);
  if (for_simbody || countStates() > 0 || !context.model.system.constraints.empty() ||
      equations::hasReaction(context.model.outputs)) {
    SimTK::GeneralForceSubsystem& subsystem = tree_.addForceSubsystem();
    SimTK::Force::Custom(subsystem, new ForceAdapter(*this, subsystem));
  }
  tree_.realize();
  motions_.resize(tree_.getMatter().getNumBodies());
  loads_.on_bodies.resize(motions_.size());
  loads_.on_speeds.resize(coordinates_.size());
  loads_.state_rates.resize(states_.size());
  forces_.on_bodies.resize(tree_.getMatter().getNumBodies());
  forces_.on_speeds.resize(tree_.getDefaultState().getNU());
  dynamics_.emplace(tree_);
}

/// What force laws see: Simbody computes it here, the recorded equations by themselves.
void LoadedSystem::readMotion(const SimTK::State& state) {
  for (std::size_t i = 1; i < motions_.size(); ++i) {
    const SimTK::MobilizedBody& body = tree_.getBody(static_cast<int>(i));
    const SimTK::Transform& pose = body.getBodyTransform(state);
    const SimTK::Rotation& r = pose.R();
    motions_[i].pose = {{toVector(r.x()), toVector(r.y()), toVector(r.z())}, toVector(pose.p())};
    motions_[i].velocity = {toVector(body.getBodyAngularVelocity(state)),
                            toVector(body.getBodyOriginVelocity(state))};
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i] = state.getZ()[static_cast<int>(i)];
  }
  const SimTK::Vector &q = state.getQ(), &rates = tree_.getMatter().getQDot(state);
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    coordinates_[i] = q[tree_.getSlots()[i].q];
    rates_[i] = rates[tree_.getSlots()[i].q];
  }
}

/// Of coordinates that take forces, whose speeds are their rates.
void LoadedSystem::readGravity(const SimTK::State& state) {
  const SimTK::SimbodyMatterSubsystem& matter = tree_.getMatter();
  SimTK::Vector_<SimTK::SpatialVec> weights(static_cast<int>(motions_.size()),
                                            SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0)));
  for (int i = 1; i < weights.size(); ++i) {
    const SimTK::SpatialInertia& inertia = tree_.getBody(i).getBodySpatialInertiaInGround(state);
    const SimTK::Vec3 weight = inertia.getMass() * getGravity();
    weights[i] = SimTK::SpatialVec(inertia.getMassCenter() % weight, weight);
  }
  SimTK::Vector on_speeds;
  matter.multiplyBySystemJacobianTranspose(state, weights, on_speeds);
  gravity_.resize(coordinates_.size());
  for (std::size_t i = 0; i < gravity_.size(); ++i) {
    gravity_[i] = on_speeds[tree_.getSlots()[i].u];
  }
}

const SystemForces& LoadedSystem::calcForces(const SimTK::State& state, double t) {
  readMotion(state);
  context_.excitation.calcValues(t, signals_);
  if (!signal_rates_.empty()) {
    context_.excitation.calcRates(t, signal_rates_);
  }
  if (context_.expressions.needsGravity()) {
    readGravity(state);
  }
  context_.expressions.setState(t, coordinates_, rates_, gravity_, states_, signals_, signal_rates_);
  std::fill(loads_.on_bodies.begin(), loads_.on_bodies.end(), equations::Spatial<double>{});
  std::fill(loads_.on_speeds.begin(), loads_.on_speeds.end(), 0.0);
  equations::ForceSum<double, StateExpressions> sum(motions_, coordinates_, rates_, states_,
                                                    context_.expressions, loads_);
  for (std::size_t i = 1; i < motions_.size(); ++i) {
    const SimTK::SpatialInertia& inertia =
        tree_.getBody(static_cast<int>(i)).getBodySpatialInertiaInGround(state);
    sum.addAt(static_cast<int>(i), toVector(inertia.getMassCenter()),
              algebra::scale(inertia.getMass(), numbers_.gravity));
  }
  equations::setStateRates(context_.model.system.states, context_.expressions, loads_);
  equations::addElementForces(numbers_.elements, sum);
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    forces_.on_bodies[i] =
        SimTK::SpatialVec(toVec3(loads_.on_bodies[i].angular), toVec3(loads_.on_bodies[i].linear));
  }
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    forces_.on_speeds[tree_.getSlots()[i].u] = loads_.on_speeds[i];
  }
  return forces_;
}

equations::Exerted<double> LoadedSystem::calcElementForce(const NamedForce& which) {
  equations::Loads<double> loads =
      equations::makeLoads<double>(motions_.size(), coordinates_.size(), states_.size());
  equations::ForceSum<double, StateExpressions> sum(motions_, coordinates_, rates_, states_,
                                                    context_.expressions, loads);
  return equations::calcElementForce(numbers_.elements, which, sum);
}

void LoadedSystem::nameAccelerations(const SimTK::State& state, const SimTK::Vector& udot) {
  SimTK::Vector second;
  tree_.getMatter().calcQDotDot(state, udot, second);
  std::vector<double> accelerations;
  for (const BodyTree::Slot& slot : tree_.getSlots()) {
    accelerations.push_back(second[slot.q]);
  }
  context_.expressions.setAccelerations(accelerations);
}

const Eigen::VectorXd& LoadedSystem::calcUDot(const SimTK::State& state, double t) {
  if (!tree_.hasConstraints()) {
    return dynamics_->calcUDot(state, calcForces(state, t));
  }
  tree_.getSystem().realize(state, SimTK::Stage::Acceleration);
  calcForces(state, t);  // for the rates of states
  const SimTK::Vector& udot = state.getUDot();
  udot_ = Eigen::Map<const Eigen::VectorXd>(udot.getContiguousScalarData(), udot.size());
  return udot_;
}

}  // namespace twinmap
