#pragma once

#include <memory>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Value and time (s) of the first maxima, then of the first minima, of an output within a window
/// (findPeaks); those that a response does not have are NaN. Throws std::invalid_argument for an output or
/// times that the layout lacks.
std::shared_ptr<const FeatureBlock> makeExtremaBlock(const ExtremaFeatureSpec& spec,
                                                     const ResponseLayout& layout);

}  // namespace twinmap
