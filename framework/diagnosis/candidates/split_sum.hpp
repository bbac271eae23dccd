#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// What an expression is the sum of, each with its sign: "u - k*q" is "u" and "-(k*q)". Sums in parentheses
/// of their own are split too. Anything else is returned as it stands.
std::vector<std::string> splitSum(const std::string& text);

}  // namespace twinmap
