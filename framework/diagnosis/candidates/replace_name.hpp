#pragma once

#include <string>

namespace twinmap {

/// Replaces a name of an expression, wherever it stands as a whole word: "x - x0", "x" by "(2*x)" is
/// "(2*x) - x0".
std::string replaceName(const std::string& text, const std::string& name, const std::string& replacement);

}  // namespace twinmap
