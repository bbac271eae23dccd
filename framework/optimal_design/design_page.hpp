#pragma once

#include <string>

#include "framework/optimal_design/excitation_design.hpp"

namespace twinmap::experiment_design {

/// One self-contained page: what the design brings each parameter (mean and worst over the box), the measures
/// against their limits, the signals before and after, correlations, what was tried, and the design for the
/// centre of the box alone beside the averaged one.
std::string makeDesignPage(const ExcitationEvaluator& evaluator, const ExcitationDesign& design);

}  // namespace twinmap::experiment_design
