#pragma once

#include <Eigen/Core>

#include "framework/estimation/box_prior.hpp"
#include "framework/estimation/surrogate/forward_samples.hpp"
#include "framework/estimation/surrogate/forward_surrogate.hpp"

namespace twinmap {

/// The standard deviations (u, in half-widths) of (information + 3 relative)^-1: what noise alone allows
/// under the prior. information: u x u, normalised, positive semi-definite.
Eigen::VectorXd calcScoreLimit(const Eigen::MatrixXd& information, const BoxPrior& prior);

/// Scores that a surrogate has no use for say something too: by what its limits are to be multiplied, for
/// each of the u unknowns. The root of the mean variance of the limit by the simulator's slopes, over that by
/// the surrogate's own, at the first 64 simulations with slopes; 1 where there are none. Cost: 64 evaluations
/// of the processes with their derivatives.
Eigen::VectorXd calcLimitScale(const ForwardSurrogate& surrogate, const ForwardSamples& samples,
                               const BoxPrior& prior);

}  // namespace twinmap
