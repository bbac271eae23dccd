#pragma once

#include <string>
#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What is believed of a measurement: the simulator's posterior where that was sampled and is reliable, else
/// the refined estimate where it was accepted, else the estimator's; with its statuses. Not given where there
/// is none of them.
Estimate selectEstimate(const InferredMeasurement& inferred);

/// The simulator's best fit; null where it was not asked, or nothing could be simulated.
const SimulatorFit* findFit(const InferredMeasurement& inferred);

/// That of a refinement that was accepted: its first p parameters.
Estimate makeEstimate(const Refined& refined, Eigen::Index parameters);

/// From this ratio to what the measurement allows on, an estimate of the estimator is estimator_limited.
constexpr double kEstimatorLimitedRatio = 1.5;

/// Whether the estimate is the estimator's and its errors are mostly the estimator's own, or not known to it.
bool isEstimatorLimited(const InferredMeasurement& inferred);

/// Whether the intervals of the run's test samples held less than they say, as this estimate was made: by the
/// estimator, or refined.
bool isUncalibrated(const InferredMeasurement& inferred);

/// Names of all that is to be said against an estimate (listNotices), the most severe first. "missing_term"
/// is first where a term explains what noise explains as well. "model_mismatch" is of the trust model or,
/// without one, of the simulator's residual (testResidual, below kMismatchLevel). Of the simulator's
/// posterior neither what the estimator was trained on nor how a refinement ended is said. {"ok"} where
/// nothing is; empty where nobody has judged.
std::vector<std::string> listStatuses(const InferredMeasurement& inferred);

bool hasStatus(const std::vector<std::string>& statuses, Notice notice);

/// Whether the most severe of the statuses is model_mismatch: then no other remedy helps.
bool isMismatch(const std::vector<std::string>& statuses);

/// Whether one of the statuses says that results may be wrong (Severity::kMisleading).
bool misleads(const std::vector<std::string>& statuses);

/// Without what noise and sensors were taken for where a term explains a measurement in their place.
void dropExcuses(std::vector<std::string>& statuses);

std::string joinStatuses(const std::vector<std::string>& statuses, const char* separator);

}  // namespace twinmap
