#include "framework/inference/answer.hpp"

#include "framework/estimation/predictions.hpp"

namespace twinmap {

namespace {

void setIntervals(Answer& answer) {
  answer.lower95 = answer.upper95 = answer.mean;
  for (Eigen::Index p = 0; p < answer.mean.size(); ++p) {
    answer.lower95[p] -= answer.reach.get(p).of95 * answer.stddev[p];
    answer.upper95[p] += answer.reach.get(p).of95 * answer.stddev[p];
  }
}

}  // namespace

Answer makeMapAnswer(const Inference& inference) {
  Answer answer{inference.mean, inference.stddev, inference.method, inference.mixture};
  answer.reach = inference.reach;
  setIntervals(answer);
  for (Eigen::Index p = 0; p < answer.mixture.means.rows(); ++p) {
    answer.intervals95.push_back(findWithin(takeMarginal(answer.mixture, p), answer.reach.get(p).of95));
    answer.lower95[p] = answer.intervals95.back().front().first;
    answer.upper95[p] = answer.intervals95.back().back().second;
  }
  return answer;
}

Answer chooseAnswer(const InferredMeasurement& inferred) {
  if (!inferred.refined || !inferred.refined->isAccepted()) {
    return makeMapAnswer(inferred.inference);
  }
  const Eigen::Index p = inferred.inference.mean.size();
  Answer answer{inferred.refined->point.head(p), inferred.refined->stddev.head(p),
                EstimationMethod::kRefined};
  setIntervals(answer);
  return answer;
}

Eigen::VectorXd calcRatioToLimit(const Inference& inference) {
  return inference.limit_stddev.size() > 0
             ? Eigen::VectorXd(inference.stddev.cwiseQuotient(inference.limit_stddev))
             : Eigen::VectorXd();
}

bool isEstimatorLimited(const InferredMeasurement& inferred) {
  if (inferred.refined && inferred.refined->isAccepted()) {
    return false;
  }
  const Eigen::VectorXd ratio = calcRatioToLimit(inferred.inference);
  return !inferred.map_is_calibrated || (ratio.size() > 0 && ratio.maxCoeff() > kEstimatorLimitedRatio);
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
  const bool several = isMultimodal(inferred.inference.mixture);
  if (several) {
    statuses.emplace_back(toString(RefinementStatus::kMultimodal));
  }
  if (inferred.refined && !inferred.refined->isAccepted() && !several) {
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
