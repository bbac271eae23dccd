#pragma once

#include <string>

#include "framework/results/comparison/run_comparison.hpp"

namespace twinmap {

/// For people: a table of the figures, what differs in the experiments, and what the intervals are.
std::string makeComparisonText(const RunComparison& comparison);

/// Columns parameter, unit, figure, a, b, difference, lower, upper, paired (1 or 0); empty where not
/// known.
std::string makeComparisonCsv(const RunComparison& comparison);

/// All of it; numbers that are not known are null.
std::string makeComparisonJson(const RunComparison& comparison);

}  // namespace twinmap
