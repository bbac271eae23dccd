#pragma once

#include <string>

#include "framework/report/figure.hpp"

namespace twinmap {

struct ExperimentSpec;

/// The page begins with the mechanism as it begins; a model from elsewhere has none. `view`: the command that
/// lets it move.
void addMechanism(const ExperimentSpec& experiment, const std::string& view, Page& page);

}  // namespace twinmap
