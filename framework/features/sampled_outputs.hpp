#pragma once

#include <memory>
#include <string>

#include "framework/features/feature_block.hpp"
#include "framework/response/response_layout.hpp"
#include "framework/spec/feature_spec.hpp"

namespace twinmap {

/// "y(0.05 s)"
std::string makeFeatureName(const std::string& output, double time);

/// Equidistant samples of outputs, output by output.
std::shared_ptr<const FeatureBlock> makeSamplesBlock(const SamplesFeatureSpec& spec,
                                                     const ResponseLayout& layout);

}  // namespace twinmap
