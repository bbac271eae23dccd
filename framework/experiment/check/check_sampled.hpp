#pragma once

#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// Adds what expressions see of controllers: their outputs and states.
void defineHeld(const std::vector<ControllerSpec>& controllers, CheckScope& scope);

/// Checks sensors, prescribed motions and controllers. `constants`: parameters and constants. Throws
/// ExperimentError for a sensor of a variable, a motion that a signal cannot prescribe, and what a controller
/// reads and computes, names and units.
void checkSampled(const ModelSpec& model, const CheckScope& constants);

}  // namespace twinmap
