#pragma once

#include <memory>

#include "framework/features/feature_block.hpp"
#include "framework/response/response_layout.hpp"
#include "framework/spec/feature_spec.hpp"

namespace twinmap {

/// Natural frequencies (Hz), then damping ratios, of the lowest modes: rows of the response. Throws
/// std::invalid_argument for more modes than the layout has.
std::shared_ptr<const FeatureBlock> makeModesBlock(const ModesFeatureSpec& spec,
                                                   const ResponseLayout& layout);

}  // namespace twinmap
