#pragma once

#include <string>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// The signal's place in the excitation. Throws ExperimentError for an unknown one.
int findSignal(const ModelSpec& model, const Name& signal);

/// The model with each controller's outputs and states also among the states of the system, where they stand
/// still: what expressions see of a controller. Once, however often it is called.
ModelSpec addControllerStates(ModelSpec model);

/// The model without what only lanes simulate: sensors that remember, round or clip, prescribed motions,
/// controllers, whose states stand still, and what switches: rigid stops, friction that sticks, whose forces
/// outputs then show as 0, dampers that begin at a touch, and armature. What no body has as its inertia
/// becomes one of 1 kg m2. `model`: of addControllerStates().
ModelSpec removeSampled(ModelSpec model);

/// The first key that removeSampled() takes out, such as "outputs.q.sensor"; "" if there is none.
std::string findSampledKey(const ModelSpec& model);

}  // namespace twinmap
