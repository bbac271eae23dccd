#pragma once

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/system_spec.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// What acts on a system, in the numbers of one parameter set; SI units.
struct LoadNumbers {
  algebra::Vec3<double> gravity;
  ForceElements<double> elements;
};

/// Throws SimulationFailure for numbers that are not finite, ExperimentError for unknown names and for a
/// force on a coordinate that takes none. `spec` must outlive the result.
LoadNumbers calcLoadNumbers(const SystemSpec& spec, const SystemNames& names, ModelNumbers& numbers);

}  // namespace twinmap
