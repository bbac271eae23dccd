#pragma once

#include <optional>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"
#include "framework/estimation/trained/trust_model.hpp"

namespace twinmap {

/// What posteriors of measurements are computed from: the map where it is a surrogate, calibrated by its
/// cross-validation, else the surrogate by which measurements are judged, whose own errors nothing has
/// scaled, under the prior of the experiment's model. None where there is neither.
std::optional<PosteriorModel> findPosteriorModel(const Estimator& map, const std::optional<TrustModel>& trust,
                                                 const ModelSpec& model);

}  // namespace twinmap
