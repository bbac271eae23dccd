#pragma once

#include <memory>

#include "framework/models/mechanism/loops/loop_model.hpp"
#include "framework/models/mechanism/model_context.hpp"

namespace twinmap {

/// Null where the model has no constraints. The context's numbers are those of the centre of the bounds
/// afterwards. Throws ExperimentError for loops that cannot be closed there, by how much and which, and for a
/// start in a singular configuration. Cost: some milliseconds.
std::shared_ptr<const LoopModel> makeLoopModel(ModelContext& context);

}  // namespace twinmap
