#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/robots/estimate_file.hpp"

namespace twinmap::cli {

/// What infer says of one measurement, the test of the model included. `run`: as of infer. Throws as infer
/// does.
robots::RobotEstimate inferEstimate(const std::string& run, const std::string& measurement,
                                    std::optional<double> start, const std::vector<std::string>& known);

}  // namespace twinmap::cli
