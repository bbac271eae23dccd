#pragma once

#include <string>

namespace twinmap::fmi {

/// Table of an FMU's variables for people, below a line about the FMU itself. Derivatives of states are
/// marked. Throws ExperimentError for a file that is no FMU.
std::string makeVariablesTable(const std::string& file);

}  // namespace twinmap::fmi
