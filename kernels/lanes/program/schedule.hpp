#pragma once

#include <vector>

#include "kernels/lanes/program/lower.hpp"

namespace twinmap::program {

/// Orders steps, operands first, so that equal operations follow each other: list scheduling which, of what
/// can be computed, takes all of the operation that the longest chain of further steps waits for. (The
/// operation with the most steps instead costs a quarter to nearly twice as many runs on small programs.)
/// Values that no step makes are there from the start. More than kLargestPiece steps are ordered piece by
/// piece, as they stand, operands first: else the values of all directions of a derivative would be there at
/// a time, far more than a cache holds. Cost: O(steps log steps) and O(ready steps) a run.
std::vector<Step> schedule(const std::vector<Step>& steps);
constexpr std::size_t kLargestPiece = 4096;

}  // namespace twinmap::program
