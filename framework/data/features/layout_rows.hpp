#pragma once

#include <string>
#include <vector>

#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Index of an output, or of a time that stands in the layout bit for bit. Throw std::invalid_argument.
Eigen::Index findOutput(const ResponseLayout& layout, const std::string& output);
Eigen::Index findTime(const ResponseLayout& layout, double time);

/// The rows of an output's samples in a window, in order of time. Throws std::invalid_argument.
std::vector<Eigen::Index> findRows(const ResponseLayout& layout, Eigen::Index output,
                                   const WindowSpec& window);

}  // namespace twinmap
