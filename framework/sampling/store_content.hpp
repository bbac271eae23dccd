#pragma once

#include <string>

#include "framework/response/response_layout.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// Names the samples of a TrajectoryStore: the model and the rows of its responses
/// (writeTrajectoryContent), and the build of the program as far as it can change a bit of them: revision of
/// the solver, compiler, instruction set, Simbody, Boost and Eigen.
std::string writeStoreContent(const ModelSpec& model, const ResponseLayout& layout);

}  // namespace twinmap
