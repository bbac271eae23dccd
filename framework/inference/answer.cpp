#include "framework/inference/answer.hpp"

namespace twinmap {

Answer chooseAnswer(const InferredMeasurement& inferred) {
  if (inferred.refined && inferred.refined->isAccepted()) {
    const Eigen::Index p = inferred.inference.mean.size();
    return {inferred.refined->point.head(p), inferred.refined->stddev.head(p), true};
  }
  return {inferred.inference.mean, inferred.inference.stddev, false};
}

std::vector<std::string> listStatuses(const InferredMeasurement& inferred) {
  std::vector<std::string> statuses;
  const bool rejected = inferred.refined && !inferred.refined->isAccepted();
  if (inferred.trust) {
    for (const TrustStatus status : inferred.trust->statuses) {
      if (status != TrustStatus::kOk || !rejected) {
        statuses.emplace_back(toString(status));
      }
    }
  }
  if (rejected) {
    statuses.emplace_back(inferred.refined->status == RefinementStatus::kNonlinear ? "nonlinear"
                                                                                   : "not_refined");
  }
  return statuses;
}

}  // namespace twinmap
