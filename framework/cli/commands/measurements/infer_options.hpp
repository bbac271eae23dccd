#pragma once

#include "framework/cli/commands/commands.hpp"
#include "framework/inference/measurement/measurement_session.hpp"

namespace twinmap::cli {

/// Throws ExperimentError for options that exclude each other.
SessionOptions makeSessionOptions(const InferArguments& arguments);

}  // namespace twinmap::cli
