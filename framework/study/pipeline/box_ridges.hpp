#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// What the features determine of parameters that they do not determine one by one, anywhere in the box: a
/// sentence for each such group (adviseOnRidges()). From the first 32 test points of the design; nothing
/// where the simulator has no exact derivatives, which would take more than some milliseconds, and without
/// the noise that an information limit needs.
std::vector<std::string> adviseOnBox(const ExperimentSpec& experiment);

}  // namespace twinmap
