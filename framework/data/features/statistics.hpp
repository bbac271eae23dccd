#pragma once

#include <memory>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Statistics of outputs over the N samples of a window: mean (a block of its own, for it is linear), then,
/// output by output, standard deviation (1/(N-1)), root mean square, smallest and largest sample and their
/// difference. Throws std::invalid_argument for outputs or times that the layout lacks.
std::vector<std::shared_ptr<const FeatureBlock>> makeStatisticsBlocks(const StatisticsFeatureSpec& spec,
                                                                      const ResponseLayout& layout);

}  // namespace twinmap
