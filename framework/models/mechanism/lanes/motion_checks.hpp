#pragma once

#include "framework/models/mechanism/model_context.hpp"

namespace twinmap {

/// Throws ExperimentError where the signal of a prescribed motion jumps within the simulation, at the centre
/// of the bounds: no force could move a body so. The context's numbers are those of the centre afterwards.
void requireSteadyMotions(ModelContext& context);

}  // namespace twinmap
