#pragma once

#include <memory>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Natural frequencies (Hz), then damping ratios, of the lowest modes: rows of the response. Throws
/// std::invalid_argument for more modes than the layout has.
std::shared_ptr<const FeatureBlock> makeModesBlock(const ModesFeatureSpec& spec,
                                                   const ResponseLayout& layout);

}  // namespace twinmap
