#include "framework/models/mechanism/simbody/loaded_system.hpp"

namespace twinmap {
namespace {

/// Shows the forces of a loaded system to Simbody's own integrators.
class ForceAdapter : public SimTK::Force::Custom::Implementation {
 public:
  explicit ForceAdapter(LoadedSystem& system) : system_(system) {}

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
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  LoadedSystem& system_;
};

}  // namespace

LoadedSystem::LoadedSystem(SimbodyContext& context, bool for_simbody)
    : context_(context),
      tree_(context.model.system, context.names, context.numbers.updNumbers()),
      passive_(calcPassiveForces(context.model.system, context.names, context.numbers.updNumbers())),
      signals_(context.excitation.getSignalCount(), 0.0) {
  context.loads.update(context.numbers.getScope(), context.numbers.updNumbers());
  context.excitation.update(context.numbers.updNumbers());
  if (for_simbody) {
    tree_.addForce(new ForceAdapter(*this));
  }
  tree_.realize();
  forces_.on_bodies.resize(tree_.getMatter().getNumBodies());
  forces_.on_speeds.resize(tree_.getDefaultState().getNU());
  dynamics_.emplace(tree_);
}

const SystemForces& LoadedSystem::calcForces(const SimTK::State& state, double t) {
  forces_.setToZero();
  ForceSum sum(tree_, state, forces_);
  addPassiveForces(passive_, sum);
  context_.excitation.calcValues(t, signals_);
  context_.loads.add(t, signals_, sum);
  return forces_;
}

const Eigen::VectorXd& LoadedSystem::calcUDot(const SimTK::State& state, double t) {
  return dynamics_->calcUDot(state, calcForces(state, t));
}

}  // namespace twinmap
