#pragma once

#include <utility>
#include <vector>

#include "kernels/sampling/box_mixture.hpp"

namespace twinmap {

/// The first draws of a posterior: most about as far from each of its modes as that says, some twice and few
/// four times as far, and few anywhere. The modes' shares add up to 1.
inline importance::BoxMixture proposeAround(const std::vector<importance::NormalPart>& modes) {
  constexpr double kNear = 0.7, kFar = 0.2, kFarthest = 0.05;
  std::vector<importance::NormalPart> parts;
  for (const importance::NormalPart& mode : modes) {
    parts.push_back({kNear * mode.share, mode.mean, 1.1 * mode.lower});
    parts.push_back({kFar * mode.share, mode.mean, 2.0 * mode.lower});
    parts.push_back({kFarthest * mode.share, mode.mean, 4.0 * mode.lower});
  }
  return importance::BoxMixture(std::move(parts));
}

}  // namespace twinmap
