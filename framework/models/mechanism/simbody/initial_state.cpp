#include "framework/models/mechanism/simbody/initial_state.hpp"

namespace twinmap {
namespace {

/// By Simbody, with central differences.
class LoadedSystemAtRest : public RestAccelerations {
 public:
  explicit LoadedSystemAtRest(LoadedSystem& system)
      : system_(system), state_(system.getTree().getDefaultState()) {}

  Eigen::VectorXd calc(const Eigen::VectorXd& q) override {
    setState(system_, {q, Eigen::VectorXd::Zero(q.size())}, state_);
    return system_.calcUDot(state_, 0.0);
  }

  Eigen::MatrixXd calcJacobian(const Eigen::VectorXd& q) override {
    Eigen::MatrixXd jacobian(q.size(), q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double h = kDifferenceStep * (1.0 + std::abs(q[i]));
      Eigen::VectorXd forward = q, backward = q;
      forward[i] += h;
      backward[i] -= h;
      jacobian.col(i) = (calc(forward) - calc(backward)) / (forward[i] - backward[i]);
    }
    return jacobian;
  }

 private:
  LoadedSystem& system_;
  SimTK::State state_;
};

}  // namespace

Eigen::VectorXd solveEquilibrium(LoadedSystem& system, const Eigen::VectorXd& start) {
  LoadedSystemAtRest at_rest(system);
  return solveEquilibrium(at_rest, start);
}

InitialState calcInitialState(ModelContext& context, LoadedSystem& system,
                              const Eigen::VectorXd& box_center) {
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  InitialState initial = calcInitialValues(context);
  if (!equilibrium) {
    return initial;
  }
  initial.speeds.setZero();
  initial.coordinates = equilibrium->at == EquilibriumAt::kBoxCenter
                            ? box_center
                            : solveEquilibrium(system, initial.coordinates);
  return initial;
}

void setState(const LoadedSystem& system, const InitialState& initial, SimTK::State& state) {
  const BodyTree& tree = system.getTree();
  SimTK::Vector qdot(state.getNQ(), 0.0);
  SimTK::Vector& q = state.updQ();
  for (std::size_t i = 0; i < tree.getSlots().size(); ++i) {
    q[tree.getSlots()[i].q] = initial.coordinates[i];
    qdot[tree.getSlots()[i].q] = initial.speeds[i];
  }
  tree.getSystem().realize(state, SimTK::Stage::Position);
  SimTK::Vector u(state.getNU());
  tree.getMatter().multiplyByNInv(state, false, qdot, u);
  state.updU() = u;
  tree.getSystem().realize(state, SimTK::Stage::Velocity);
}

}  // namespace twinmap
