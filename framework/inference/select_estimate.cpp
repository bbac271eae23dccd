#include "framework/inference/select_estimate.hpp"

namespace twinmap {

Estimate selectEstimate(const InferredMeasurement& inferred) {
  Estimate estimate = inferred.refined && inferred.refined->isAccepted()
                          ? makeEstimate(*inferred.refined, inferred.by_estimator.mean.size())
                          : inferred.by_estimator;
  estimate.statuses = listStatuses(inferred);
  return estimate;
}

Estimate makeEstimate(const Refined& refined, Eigen::Index parameters) {
  Estimate estimate{refined.point.head(parameters), refined.stddev.head(parameters)};
  estimate.correlation = calcCorrelation(refined.covariance.topLeftCorner(parameters, parameters));
  estimate.method = EstimationMethod::kRefined;
  return estimate;
}

bool isEstimatorLimited(const InferredMeasurement& inferred) {
  if (inferred.refined && inferred.refined->isAccepted()) {
    return false;
  }
  const Eigen::VectorXd ratio = inferred.by_estimator.calcRatioToLimit();
  return !inferred.estimator_is_calibrated || (ratio.size() > 0 && ratio.maxCoeff() > kEstimatorLimitedRatio);
}

std::vector<std::string> listStatuses(const InferredMeasurement& inferred) {
  std::vector<std::string> statuses;
  if (inferred.trust) {
    for (const TrustStatus status : inferred.trust->statuses) {
      if (status != TrustStatus::kOk) {
        statuses.emplace_back(toString(status));
      }
    }
  }
  const bool multimodal = isMultimodal(inferred.by_estimator.mixture);
  if (multimodal) {
    statuses.emplace_back(toString(RefinementStatus::kMultimodal));
  }
  if (inferred.refined && !inferred.refined->isAccepted() && !multimodal) {
    statuses.emplace_back(inferred.refined->status == RefinementStatus::kNonlinear ? "nonlinear"
                                                                                   : "not_refined");
  }
  if (isEstimatorLimited(inferred)) {
    statuses.emplace_back("estimator_limited");
  }
  if (statuses.empty() && inferred.trust) {
    statuses.emplace_back(toString(TrustStatus::kOk));
  }
  return statuses;
}

}  // namespace twinmap
