#pragma once

#include <string>

namespace twinmap {

/// What is wrong with where a line (from 0) of a YAML file begins, in words with lines and columns from 1:
/// it begins between two levels, beside keys though it is an item, or below a key that has its value
/// already. Empty if it begins where a line may. One pass over the lines before it.
std::string describeLayout(const std::string& text, int line);

}  // namespace twinmap
