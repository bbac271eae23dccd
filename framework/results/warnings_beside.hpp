#pragma once

#include <vector>

#include "framework/base/log/notice.hpp"

namespace twinmap {

/// Takes away the remedies of a run's warnings that go against another one, or that have been taken.
/// are_refined: whether nearly all estimates are refined.
void mendRemedies(std::vector<Warning>& warnings, bool are_refined);

}  // namespace twinmap
