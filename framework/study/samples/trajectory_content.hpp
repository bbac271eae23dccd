#pragma once

#include <string>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// YAML of all that determines a clean response beside the parameter point and the program: two models with
/// the same text have the same responses. Left out is what does not change a response: descriptions, units,
/// which parameters are to be inferred, the file a table was measured in, the limits that only decide when to
/// give up (max_wall_time, allowed_failures), and the bounds of the parameters, of which only the centre
/// counts, where the initial state is the equilibrium there.
std::string writeTrajectoryContent(const ModelSpec& model, const ResponseLayout& layout);

}  // namespace twinmap
