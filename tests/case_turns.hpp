#pragma once

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace twinmap::testing {

/// Of cases 0 .. count - 1 those whose turn it is: every fifth, by the commit; all with TWINMAP_ALL_CASES
/// (tests/case_turns.py). Says what repeats a failure.
inline std::vector<int> takeTurn(int count) {
  constexpr int kTurns = 5;
  const char* given = std::getenv("TWINMAP_TEST_SEED");
  const std::string seed = given != nullptr ? given : "0";
  const bool all = std::getenv("TWINMAP_ALL_CASES") != nullptr;
  std::cout << "TWINMAP_TEST_SEED=" << seed << (all ? " TWINMAP_ALL_CASES=1" : "") << " repeats this\n";
  std::vector<int> cases;
  const int first = all ? 0 : static_cast<int>(std::stoul(seed, nullptr, 16) % kTurns);
  for (int i = first; i < count; i += all ? 1 : kTurns) {
    cases.push_back(i);
  }
  return cases;
}

}  // namespace twinmap::testing
