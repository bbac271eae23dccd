#pragma once

#include <vector>

#include "bench/simulation/comparison.hpp"

namespace twinmap::bench {

/// Markdown tables.
void printComparisons(const std::vector<Comparison>& comparisons);
void printLanes(const std::vector<Comparison>& comparisons);
void printPrograms(const std::vector<Comparison>& comparisons, const ProgramCost& multiply_adds,
                   const ProgramCost& sines);

}  // namespace twinmap::bench
