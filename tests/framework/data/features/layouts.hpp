#pragma once

#include "framework/data/features/feature_extractor.hpp"

namespace twinmap {

/// Of one output y, m, at the times that the features need.
inline ResponseLayout makeLayout(const std::vector<FeatureSpec>& features) {
  return {{"y"}, {"m"}, collectTimes(features)};
}

}  // namespace twinmap
