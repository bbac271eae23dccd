#include "framework/models/mechanism/simbody/initial_state.hpp"

namespace twinmap {
namespace {

/// By Simbody, with central differences.
class LoadedSystemAtRest : public RestAccelerations {
 public:
  explicit LoadedSystemAtRest(LoadedSystem& system)
      : system_(system), state_(system.getTree().getDefaultState()) {}

  Eigen::VectorXd calc(const Eigen::VectorXd& q) override {
    const Eigen::Index n = countCoordinates();
    setState(system_, {q.head(n), Eigen::VectorXd::Zero(n), q.tail(q.size() - n)}, state_);
    SimbodyContext& context = system_.getContext();
    const Eigen::VectorXd open = context.assembly
                                     ? context.assembly->calcDistances(getParameters(context), q.head(n))
                                     : Eigen::VectorXd();
    Eigen::VectorXd rates(q.size() + open.size());
    rates.head(n) = system_.calcUDot(state_, 0.0);
    std::copy(system_.getStateRates().begin(), system_.getStateRates().end(), rates.begin() + n);
    rates.tail(open.size()) = kClosureWeight * open;
    return rates;
  }

  Eigen::MatrixXd calcJacobian(const Eigen::VectorXd& q) override {
    const Eigen::VectorXd center = calc(q);
    Eigen::MatrixXd jacobian(center.size(), q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double h = kDifferenceStep * (1.0 + std::abs(q[i]));
      Eigen::VectorXd forward = q, backward = q;
      forward[i] += h;
      backward[i] -= h;
      jacobian.col(i) = (calc(forward) - calc(backward)) / (forward[i] - backward[i]);
    }
    if (system_.countStates() > 0) {
      holdIndifferentStates(center.head(q.size()), countCoordinates(), jacobian);
    }
    return jacobian;
  }

 private:
  Eigen::Index countCoordinates() const {
    return static_cast<Eigen::Index>(system_.getTree().getSlots().size());
  }

  LoadedSystem& system_;
  SimTK::State state_;
};

}  // namespace

InitialState assemble(SimbodyContext& context, InitialState initial) {
  if (context.assembly) {
    const Eigen::VectorXd parameters = getParameters(context);
    initial.coordinates = context.assembly->close(parameters, initial.coordinates);
    initial.speeds = context.assembly->calcRates(parameters, initial.coordinates, initial.speeds);
  }
  return initial;
}

Eigen::VectorXd solveEquilibrium(LoadedSystem& system, const Eigen::VectorXd& start) {
  LoadedSystemAtRest at_rest(system);
  return solveEquilibrium(at_rest, start);
}

InitialState calcInitialState(SimbodyContext& context, LoadedSystem& system,
                              const Eigen::VectorXd& box_center) {
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  const InitialState initial = assemble(context, calcInitialValues(context));
  if (!equilibrium) {
    return initial;
  }
  const Eigen::VectorXd solved = equilibrium->at == EquilibriumAt::kBoxCenter
                                     ? box_center
                                     : solveEquilibrium(system, initial.getEquilibrium());
  const Eigen::Index n = initial.coordinates.size();
  return assemble(context, {solved.head(n), Eigen::VectorXd::Zero(n), solved.tail(solved.size() - n)});
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
  for (Eigen::Index i = 0; i < initial.states.size(); ++i) {
    state.updZ()[static_cast<int>(i)] = initial.states[i];
  }
  tree.getSystem().realize(state, SimTK::Stage::Velocity);
}

}  // namespace twinmap
