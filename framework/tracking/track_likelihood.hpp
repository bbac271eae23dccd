#pragma once

#include "framework/estimation/estimate.hpp"
#include "framework/tracking/track_space.hpp"
#include "kernels/tracking/model.hpp"

namespace twinmap {

/// Whether a measurement with this estimate updates the belief, by its statuses; use: those that do although
/// they do not by themselves.
bool informs(const Estimate& estimate, const std::vector<std::string>& use);

/// The likelihood of an estimate of p parameters, as rows of a linear measurement. The prior that the
/// estimate contains is taken out, so that it counts once: information and its weighted mean are subtracted.
/// Uniform priors are normal ones in refined estimates; in others they are what the bounds have cut off.
/// Directions of which the measurement says hardly more than the prior have no row. Several separate values,
/// a ridge and draws that bend are modes. Time and conditions are the caller's.
tracking::Measurement makeTrackMeasurement(const Estimate& estimate, const TrackSpace& space,
                                           const TrackPrior& prior);

}  // namespace twinmap
