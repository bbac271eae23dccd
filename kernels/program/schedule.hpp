#pragma once

#include <vector>

#include "kernels/program/lower.hpp"

namespace twinmap::program {

/// Orders steps, operands first, so that equal operations follow each other: of what can be computed, always
/// the operation next that most steps wait for. Values that no step makes are there from the start. Cost:
/// O(steps log steps).
std::vector<Step> schedule(const std::vector<Step>& steps);

}  // namespace twinmap::program
