#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/report/html.hpp"
#include "framework/results/gates.hpp"

namespace twinmap {

// Pieces of the first chapter, which runs and sweeps share.

/// Names and values side by side.
std::string makeFacts(const std::vector<std::pair<std::string, std::string>>& facts);
/// Each gate, passed or failed, in words and by a sign.
std::string makeGateList(const std::vector<GateResult>& gates);
/// "" without warnings.
std::string makeWarningList(const std::vector<std::string>& warnings);

}  // namespace twinmap
