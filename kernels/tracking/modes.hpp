#pragma once

#include "kernels/tracking/belief.hpp"

namespace twinmap::tracking {

/// The likelihood that takes one normal belief of p parameters to another, as rows of unit noise. Directions
/// in which it has hardly more information than the first belief have none: the sd would be above .9 of that.
/// Some parameters may have been uniform before, from -1 to 1, where the first belief has no correlation.
/// What the bounds have made of the second one (calcBoxSite()) is then taken out of it, in the place of the
/// first.
Measurement makeLikelihood(const Belief& before, const Belief& after,
                           const std::vector<Eigen::Index>& uniform = {});

/// The likelihood of a mixture of normal beliefs (weights: of sum 1) from one before it. `after` has at least
/// one.
Measurement makeLikelihood(const Belief& before, const std::vector<Belief>& after,
                           const Eigen::VectorXd& weights, const std::vector<Eigen::Index>& uniform = {});

/// What a measurement says: itself where it has no modes. Else the normal likelihood that gives this belief
/// the mean and covariance which all modes together give it (assumed density filtering). One mode that the
/// belief makes a thousand times as likely as all others is taken as it is. Where all contradict the belief
/// that is the nearest.
Measurement resolveModes(const Model& model, const Measurement& measurement, const Eigen::VectorXd& reference,
                         const Belief& belief);

}  // namespace twinmap::tracking
