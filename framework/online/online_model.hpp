#pragma once

#include <optional>

#include "framework/inverse_map/gp_map.hpp"
#include "framework/online/trust_model.hpp"

namespace twinmap {

/// All that is needed to infer from a measurement and to judge that.
struct OnlineModel {
  GpMap map;                        ///< compressed
  std::optional<TrustModel> trust;  ///< none where a feature has no noise or the simulations are too few
};

}  // namespace twinmap
