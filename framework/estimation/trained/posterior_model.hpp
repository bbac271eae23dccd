#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"
#include "framework/estimation/trained/trust_model.hpp"

namespace twinmap {

/// What posteriors of measurements are computed from: the map where it is a surrogate, calibrated by its
/// cross-validation, else the surrogate by which measurements are judged, whose own errors nothing has
/// scaled, under the prior of the experiment's model. None where there is neither.
std::optional<PosteriorModel> findPosteriorModel(const Estimator& map, const std::optional<TrustModel>& trust,
                                                 const ModelSpec& model);

/// What speaks against the posteriors of that model, a phrase; "" where nothing does. Where a run has ranked
/// true values among their draws (TrustModel::posteriors), that alone decides. Else the cross-validation of
/// the map's surrogate must not have had to enlarge its standard deviations
/// (SurrogateValidation::listEnlarged): a factor makes intervals hold, but not the posterior right. Of
/// another map's surrogate nothing is known without ranks.
std::string findPosteriorDoubt(const Estimator& map, const std::optional<TrustModel>& trust,
                               const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
