#pragma once

#include <memory>
#include <optional>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/trained/trust_model.hpp"

namespace twinmap {

/// All that is needed to infer from a measurement and to judge that.
struct OnlineModel {
  std::shared_ptr<const Estimator> map;  ///< processes compressed; a surrogate is that of the trust model
  std::optional<TrustModel> trust;       ///< none where a feature has no noise or the simulations are too few
  /// p: standard deviation of the map's errors without noise, over the stated one. All measurements of one
  /// machine have such an error alike. Empty where nobody looked.
  Eigen::VectorXd shared_error{};
};

}  // namespace twinmap
