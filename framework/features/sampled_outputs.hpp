#pragma once

#include <memory>
#include <string>

#include "framework/features/feature_block.hpp"
#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/response_layout.hpp"

namespace twinmap {

/// Index of an output, or of a time that stands in the layout bit for bit. Throw std::invalid_argument.
Eigen::Index findOutput(const ResponseLayout& layout, const std::string& output);
Eigen::Index findTime(const ResponseLayout& layout, double time);

/// "y(0.05 s)"
std::string makeFeatureName(const std::string& output, double time);

/// Equidistant samples of outputs, output by output.
std::shared_ptr<const FeatureBlock> makeSamplesBlock(const SamplesFeatureSpec& spec,
                                                     const ResponseLayout& layout);

}  // namespace twinmap
