#include "framework/models/mechanism/initial_state.hpp"

namespace twinmap {
namespace {

Eigen::VectorXd calcNamed(const std::vector<NamedExpression>& values, const char* what,
                          ModelContext& context) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(context.names.getCoordinateNames().size());
  for (const NamedExpression& value : values) {
    const std::string owner = "initial condition of '" + value.name.text + "'";
    result[context.names.findCoordinate(value.name)] =
        context.numbers.updNumbers().calc(value.value, {owner, what, ""});
  }
  return result;
}

}  // namespace

InitialState calcInitialValues(ModelContext& context) {
  const InitialSpec& initial = context.model.initial;
  return {calcNamed(initial.coordinates, "coordinate", context), calcNamed(initial.speeds, "speed", context)};
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
