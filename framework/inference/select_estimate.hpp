#pragma once

#include <string>
#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What is believed of a measurement: the refined estimate where it was accepted, else the estimator's; with
/// its statuses.
Estimate selectEstimate(const InferredMeasurement& inferred);

/// That of a refinement that was accepted: its first p parameters.
Estimate makeEstimate(const Refined& refined, Eigen::Index parameters);

/// From this ratio to what the measurement allows on, an estimate of the estimator is estimator_limited.
constexpr double kEstimatorLimitedRatio = 1.5;

/// Whether the estimate is the estimator's and its errors are mostly the estimator's own, or not known to it.
bool isEstimatorLimited(const InferredMeasurement& inferred);

/// Names of all that is to be said against an estimate, the most severe first: what the trust model says,
/// then "multimodal" where a mixture's components lie apart, "nonlinear" or "not_refined" where a refinement
/// was tried and not accepted, then "estimator_limited". {"ok"} where nothing is; empty where nobody has
/// judged.
std::vector<std::string> listStatuses(const InferredMeasurement& inferred);

}  // namespace twinmap
