#pragma once

#include <memory>
#include <vector>

#include "framework/features/feature_block.hpp"
#include "framework/response/response_layout.hpp"
#include "framework/spec/feature_spec.hpp"

namespace twinmap {

/// Statistics of outputs over the N samples of a window: mean (a block of its own, for it is linear), then,
/// output by output, standard deviation (1/(N-1)), root mean square, smallest and largest sample and their
/// difference. Throws std::invalid_argument for outputs or times that the layout lacks.
std::vector<std::shared_ptr<const FeatureBlock>> makeStatisticsBlocks(const StatisticsFeatureSpec& spec,
                                                                      const ResponseLayout& layout);

}  // namespace twinmap
