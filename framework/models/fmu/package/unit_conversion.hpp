#pragma once

#include <string>

#include "framework/experiment/expression/units.hpp"
#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// Between a quantity of the experiment, in coherent SI, and a variable of an FMU, in the unit of its model
/// description.
struct VariableUnits {
  UnitConversion to_fmu, from_fmu;
};

/// `unit`: of the experiment, "" if not stated. The FMU's unit is what its unit definitions say; without base
/// units what UDUNITS knows by its name. A unit that neither knows is taken for the experiment's. Throws
/// ExperimentError for another dimension, and where the experiment states none and the FMU's is not coherent
/// SI.
VariableUnits calcVariableUnits(const ModelDescription& description, const Variable& variable,
                                const std::string& unit, const SourceLocation& where);

}  // namespace twinmap::fmi
