#pragma once

#include <memory>

#include "framework/features/feature_block.hpp"
#include "framework/response/response_layout.hpp"
#include "framework/spec/feature_spec.hpp"

namespace twinmap {

/// Lines of the outputs' spectra (complex_lines.hpp), output by output. Throws std::invalid_argument for
/// outputs or times that the layout lacks.
std::shared_ptr<const FeatureBlock> makeSpectrumBlock(const SpectrumFeatureSpec& spec,
                                                      const ResponseLayout& layout);

}  // namespace twinmap
