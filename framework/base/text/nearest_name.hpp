#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// "; did you mean 'stiffness'?" for the candidate with the smallest edit distance to `name`, or "" if none
/// is near (more than a third of the letters differ).
std::string suggestName(const std::string& name, const std::vector<std::string>& candidates);

/// "a, b, c".
std::string listNames(const std::vector<std::string>& names);

}  // namespace twinmap
