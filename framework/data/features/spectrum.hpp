#pragma once

#include <memory>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// Lines of the outputs' spectra (complex_lines.hpp), output by output. Throws std::invalid_argument for
/// outputs or times that the layout lacks.
std::shared_ptr<const FeatureBlock> makeSpectrumBlock(const SpectrumFeatureSpec& spec,
                                                      const ResponseLayout& layout);

}  // namespace twinmap
