#pragma once

#include "framework/report/figure.hpp"
#include "framework/results/run_folder.hpp"

namespace twinmap {

/// The figure of the highlighted samples' clean responses, and the responses of all drawn test samples for
/// the page's script: 16-bit fractions of each output's range in base64, at most 200 times each.
void addSelectedResponses(const RunFolder& run, Section& section, Page& page);

}  // namespace twinmap
