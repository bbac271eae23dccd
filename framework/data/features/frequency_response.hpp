#pragma once

#include <memory>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/simulation/input_signals.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// H(f) = Y(f) / U(f) of each output Y, output by output, with lines of the discrete Fourier transform over
/// the window (complex_lines.hpp). As U is known, H is linear in the response. Throws std::invalid_argument
/// for outputs, times or signals that are lacking, and ExperimentError for a frequency whose U(f) is below
/// 1e-6 of the signal's largest value.
std::shared_ptr<const FeatureBlock> makeFrequencyResponseBlock(const FrequencyResponseFeatureSpec& spec,
                                                               const ResponseLayout& layout,
                                                               const InputSignals& inputs);

}  // namespace twinmap
