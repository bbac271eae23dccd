#pragma once

#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/run/run_setting.hpp"

namespace twinmap::fmi {

/// A value of the experiment and the FMU's variable that it is.
struct VariableUse {
  std::string variable;  ///< "spring.c", "a[2]"
  std::string unit;      ///< of the experiment's value
  SourceLocation where;  ///< of what messages point at
};

// Each finds the variables and their units. Throw ExperimentError at `where` for a variable that does not
// exist (with the nearest name), whose unit is of another dimension, or that may not be used so, with the
// reason.

/// Variables that the standard permits to set before the initialisation: parameters (fixed, tunable), start
/// values (initial exact or approx), inputs that stay constant.
BoundVariables bindParameters(const ModelDescription& description, const std::vector<VariableUse>& uses);
BoundVariables bindInputs(const ModelDescription& description, const std::vector<VariableUse>& uses);
/// Any variable that is a number.
BoundVariables bindOutputs(const ModelDescription& description, const std::vector<VariableUse>& uses);

/// Why a variable may not be set before the initialisation, or "".
std::string explainFixed(const Variable& variable);

}  // namespace twinmap::fmi
