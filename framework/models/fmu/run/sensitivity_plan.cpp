#include "framework/models/fmu/run/sensitivity_plan.hpp"

#include <algorithm>

namespace twinmap::fmi {
namespace {

/// Thrown within this file: there is no plan.
struct NoPlan {};

void require(bool condition) {
  if (!condition) {
    throw NoPlan{};
  }
}

int findState(const SensitivityPlan& plan, const Variable& variable) {
  const auto found = std::find(plan.states.begin(), plan.states.end(), variable.reference);
  return found == plan.states.end() ? -1 : static_cast<int>(found - plan.states.begin());
}

void addStates(const ModelDescription& description, SensitivityPlan& plan) {
  for (const int index : description.state_derivatives) {
    const Variable& derivative = description.variables[index];
    require(derivative.derivative_of >= 0);
    const Variable& state = description.variables[derivative.derivative_of];
    require(derivative.dimensions.empty() && state.dimensions.empty() && state.initial == Initial::kExact &&
            state.type == Type::kFloat64);
    plan.states.push_back(state.reference);
    plan.derivatives.push_back(derivative.reference);
  }
}

bool hasKnownDerivative(const ModelDescription& description, const Variable& variable) {
  if (variable.causality == Causality::kInput) {
    return variable.variability == Variability::kContinuous;
  }
  return description.version == Version::k3 && variable.causality == Causality::kParameter &&
         variable.variability == Variability::kTunable &&
         description.dependencies.count(variable.reference) > 0;
}

void addParameter(const ModelDescription& description, const BoundVariables& settable, std::size_t slot,
                  SensitivityPlan& plan) {
  const Variable& variable = *settable.slots[slot].variable;
  SensitivityPlan::Parameter parameter;
  parameter.factor = settable.units[slot].factor;
  parameter.state = findState(plan, variable);
  require(variable.type == Type::kFloat64 && variable.dimensions.empty());
  if (parameter.state < 0) {
    require(hasKnownDerivative(description, variable));
    parameter.known = variable.reference;
  }
  plan.parameters.push_back(parameter);
}

void addOutput(const BoundVariables& outputs, std::size_t slot, SensitivityPlan& plan) {
  const Variable& variable = *outputs.slots[slot].variable;
  const int state = findState(plan, variable);
  const bool unknown = std::count(plan.derivatives.begin(), plan.derivatives.end(), variable.reference) > 0 ||
                       (variable.causality == Causality::kOutput && variable.type == Type::kFloat64 &&
                        variable.variability == Variability::kContinuous);
  require((state >= 0 || unknown) && variable.dimensions.empty());
  plan.outputs.push_back({state, variable.reference, outputs.units[slot].factor});
}

SensitivityPlan makePlan(const ModelDescription& description, const RunSetting& setting,
                         std::size_t sampled) {
  require(setting.kind == Kind::kModelExchange && description.model_exchange->directional_derivatives &&
          !description.state_derivatives.empty());
  SensitivityPlan plan;
  addStates(description, plan);
  const std::vector<std::size_t>& sources = setting.parameters.sources;
  for (std::size_t i = 0; i < sampled; ++i) {
    const auto found = std::find(sources.begin(), sources.end(), i);
    require(found != sources.end());
    addParameter(description, setting.parameters, static_cast<std::size_t>(found - sources.begin()), plan);
  }
  for (std::size_t i = 0; i < setting.outputs.slots.size(); ++i) {
    addOutput(setting.outputs, i, plan);
  }
  return plan;
}

}  // namespace

std::optional<SensitivityPlan> planSensitivities(const ModelDescription& description,
                                                 const RunSetting& setting, std::size_t sampled) {
  try {
    return makePlan(description, setting, sampled);
  } catch (const NoPlan&) {
    return std::nullopt;
  }
}

}  // namespace twinmap::fmi
