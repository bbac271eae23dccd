#include "framework/models/fmu/run/bind_variables.hpp"

#include "framework/base/text/nearest_name.hpp"

namespace twinmap::fmi {
namespace {

ValueSlot findSlotFor(const ModelDescription& description, const VariableUse& use) {
  try {
    return findSlot(description, use.variable);
  } catch (const ExperimentError& error) {
    throw ExperimentError(use.where, use.variable, error.what());
  }
}

[[noreturn]] void refuseUse(const VariableUse& use, const std::string& reason) {
  throw ExperimentError(use.where, use.variable, reason);
}

std::string listInputs(const ModelDescription& description) {
  std::vector<std::string> names;
  for (const Variable& variable : description.variables) {
    if (variable.causality == Causality::kInput && isNumeric(variable.type)) {
      names.push_back(variable.name);
    }
  }
  return names.empty() ? "it has no inputs" : "its inputs are " + listNames(names);
}

/// `select(slot, units)`: the direction, or throws.
template <class Select>
BoundVariables bindEach(const ModelDescription& description, const std::vector<VariableUse>& uses,
                        const Select& select) {
  BoundVariables bound;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const ValueSlot slot = findSlotFor(description, uses[i]);
    const VariableUnits units = calcVariableUnits(description, *slot.variable, uses[i].unit, uses[i].where);
    bound.slots.push_back(slot);
    bound.units.push_back(select(uses[i], *slot.variable, units));
    bound.sources.push_back(i);
  }
  return bound;
}

}  // namespace

std::string explainFixed(const Variable& variable) {
  const bool start_value = variable.initial == Initial::kExact || variable.initial == Initial::kApprox;
  if (variable.variability == Variability::kConstant) {
    return "the FMU's variable is a constant";
  }
  switch (variable.causality) {
    case Causality::kStructuralParameter:
      return "the FMU's variable is a structural parameter: it changes the sizes of the model";
    case Causality::kIndependent:
      return "the FMU's variable is the time";
    case Causality::kCalculatedParameter:
      return "the FMU's variable is calculated from other parameters; set those";
    case Causality::kParameter:
    case Causality::kInput:
      return "";
    default:
      return start_value ? ""
                         : "the FMU calculates this variable; only parameters and start values can be set";
  }
}

BoundVariables bindParameters(const ModelDescription& description, const std::vector<VariableUse>& uses) {
  return bindEach(description, uses,
                  [](const VariableUse& use, const Variable& variable, const VariableUnits& units) {
                    if (const std::string reason = explainFixed(variable); !reason.empty()) {
                      refuseUse(use, "cannot be set: " + reason);
                    }
                    return units.to_fmu;
                  });
}

BoundVariables bindInputs(const ModelDescription& description, const std::vector<VariableUse>& uses) {
  return bindEach(
      description, uses, [&](const VariableUse& use, const Variable& variable, const VariableUnits& units) {
        if (variable.causality != Causality::kInput) {
          refuseUse(use, "is not an input of the FMU but a " + std::string(toText(variable.causality)) +
                             "; " + listInputs(description));
        }
        return units.to_fmu;
      });
}

BoundVariables bindOutputs(const ModelDescription& description, const std::vector<VariableUse>& uses) {
  return bindEach(description, uses, [](const VariableUse&, const Variable&, const VariableUnits& units) {
    return units.from_fmu;
  });
}

}  // namespace twinmap::fmi
