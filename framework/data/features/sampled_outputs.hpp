#pragma once

#include <memory>
#include <string>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// "y(0.05 s)"
std::string makeFeatureName(const std::string& output, double time);

/// Equidistant samples of outputs, output by output.
std::shared_ptr<const FeatureBlock> makeSamplesBlock(const SamplesFeatureSpec& spec,
                                                     const ResponseLayout& layout);

}  // namespace twinmap
