#include "framework/inference/answer.hpp"

namespace twinmap {

Answer chooseAnswer(const InferredMeasurement& inferred) {
  if (inferred.refined && inferred.refined->isAccepted()) {
    const Eigen::Index p = inferred.inference.mean.size();
    return {inferred.refined->point.head(p), inferred.refined->stddev.head(p), true};
  }
  return {inferred.inference.mean, inferred.inference.stddev, false};
}

Eigen::VectorXd calcRatioToLimit(const Inference& inference) {
  return inference.limit_stddev.size() > 0
             ? Eigen::VectorXd(inference.stddev.cwiseQuotient(inference.limit_stddev))
             : Eigen::VectorXd();
}

bool isMapLimited(const InferredMeasurement& inferred) {
  if (inferred.refined && inferred.refined->isAccepted()) {
    return false;
  }
  const Eigen::VectorXd ratio = calcRatioToLimit(inferred.inference);
  return !inferred.map_is_honest || (ratio.size() > 0 && ratio.maxCoeff() > kMapLimitedRatio);
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
  if (inferred.refined && !inferred.refined->isAccepted()) {
    statuses.emplace_back(inferred.refined->status == RefinementStatus::kNonlinear ? "nonlinear"
                                                                                   : "not_refined");
  }
  if (isMapLimited(inferred)) {
    statuses.emplace_back("map_limited");
  }
  if (statuses.empty() && inferred.trust) {
    statuses.emplace_back(toString(TrustStatus::kOk));
  }
  return statuses;
}

}  // namespace twinmap
