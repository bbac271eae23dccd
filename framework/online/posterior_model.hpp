#pragma once

#include <optional>

#include "framework/online/online_map.hpp"
#include "framework/online/trust_model.hpp"
#include "framework/surrogate/posterior_sampler.hpp"

namespace twinmap {

/// What posteriors of measurements are computed from: the map where it is a surrogate, calibrated by its
/// cross-validation, else the surrogate by which measurements are judged, whose own errors nothing has
/// scaled. None where there is neither.
std::optional<PosteriorModel> findPosteriorModel(const OnlineMap& map,
                                                 const std::optional<TrustModel>& trust);

}  // namespace twinmap
