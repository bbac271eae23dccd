#include "framework/inference/select_estimate.hpp"

#include <algorithm>

#include "framework/base/log/notice.hpp"

namespace twinmap {
namespace {

using Statuses = std::vector<std::string>;

const PosteriorEstimate* findSimulated(const InferredMeasurement& inferred) {
  return inferred.posterior && inferred.posterior->fit ? &*inferred.posterior : nullptr;
}

/// Whether the simulator's posterior is the estimate.
bool isSampled(const InferredMeasurement& inferred) {
  const PosteriorEstimate* posterior = findSimulated(inferred);
  return posterior != nullptr && posterior->isReliable();
}

bool isAccepted(const InferredMeasurement& inferred) {
  return inferred.refined && inferred.refined->isAccepted();
}

/// By the trust model, where there is one, else by the residual of the simulator's best point. The trust
/// model does not ask whether neighbours are alike; its false alarms are to stay what they are, so that a
/// tenth of their level is enough here.
bool leavesMisfit(const InferredMeasurement& inferred) {
  const SimulatorFit* fit = findFit(inferred);
  if (inferred.trust) {
    const std::vector<TrustStatus>& all = inferred.trust->statuses;
    return std::find(all.begin(), all.end(), TrustStatus::kModelMismatch) != all.end() ||
           (fit != nullptr && fit->test.whiteness_p < kRareLevel);
  }
  return fit != nullptr && fit->test.calcPValue() < kMismatchLevel;
}

/// What the noise has that was not stated.
void addNoise(const SimulatorFit& fit, Statuses& statuses) {
  if (const double factor = fit.getNoiseFactor(); factor != 1.0) {
    statuses.emplace_back(factor > 1.0 ? "noise_larger" : "noise_smaller");
  }
  if (fit.isColoured()) {
    statuses.emplace_back("noise_coloured");
  }
  if (fit.hasOffset()) {
    statuses.emplace_back("sensor_offset");
  }
}

/// Where the simulator's best point lies beyond them, whatever is said beside.
void addBounds(const InferredMeasurement& inferred, Statuses& statuses) {
  const PosteriorEstimate* posterior = findSimulated(inferred);
  if (posterior != nullptr && !posterior->fit->beyond.empty() && !hasStatus(statuses, Notice::kAtBounds)) {
    statuses.emplace_back(toString(TrustStatus::kAtBounds));
  }
}

Statuses listOfSampled(const InferredMeasurement& inferred) {
  Statuses statuses;
  if (leavesMisfit(inferred)) {
    statuses.emplace_back(toString(TrustStatus::kModelMismatch));
  }
  addBounds(inferred, statuses);
  if (inferred.posterior->fit && !inferred.posterior->fit->outliers.empty()) {
    statuses.emplace_back("outliers");
  }
  if (inferred.nuisance) {
    statuses.emplace_back(getNotice(inferred.nuisance->notice).name);
  }
  if (inferred.posterior->fit) {
    addNoise(*inferred.posterior->fit, statuses);
  }
  addStatus(inferred.posterior->shape, statuses);
  return statuses;
}

void addRefinement(const InferredMeasurement& inferred, Statuses& statuses) {
  const bool multimodal = inferred.by_estimator.isMultimodal();
  if (multimodal) {
    statuses.emplace_back(toString(RefinementStatus::kMultimodal));
  }
  if (inferred.refined && !inferred.refined->isAccepted() && !multimodal) {
    statuses.emplace_back(inferred.refined->status == RefinementStatus::kNonlinear ? "nonlinear"
                                                                                   : "not_refined");
  }
}

/// Of the refined or the estimator's estimate, or of none.
Statuses listOfOthers(const InferredMeasurement& inferred) {
  Statuses statuses;
  if (inferred.trust) {
    for (const TrustStatus status : inferred.trust->statuses) {
      if (status != TrustStatus::kOk) {
        statuses.emplace_back(toString(status));
      }
    }
  } else if (leavesMisfit(inferred)) {
    statuses.emplace_back(toString(TrustStatus::kModelMismatch));
  }
  if (!isAccepted(inferred)) {
    addBounds(inferred, statuses);
  }
  addRefinement(inferred, statuses);
  if (findSimulated(inferred) != nullptr) {
    statuses.emplace_back(inferred.posterior->getStatus());
  }
  if (isUncalibrated(inferred)) {
    statuses.emplace_back("uncalibrated");
  }
  if (isEstimatorLimited(inferred)) {
    statuses.emplace_back("estimator_limited");
  }
  return statuses;
}

/// A term goes before noise that explains a measurement as well. What the noise was taken for is then left
/// out, if stated noise remains with the term. So it goes before a nuisance of the recording, which is said
/// beside.
void addMissing(const InferredMeasurement& inferred, Statuses& statuses) {
  const MissingTerm* missing = inferred.findMissing();
  const bool is_said =
      missing != nullptr && !isMismatch(statuses) &&
      (!inferred.nuisance || (missing->explains && !inferred.nuisance->isAlike(missing->term)));
  if (!is_said) {
    return;
  }
  if (missing->explains && !inferred.nuisance) {
    dropExcuses(statuses);
  }
  statuses.insert(statuses.begin(), "missing_term");
}

/// What recordings that disagree say of the machine is as wide as they scatter.
void widen(const std::vector<ScatterEstimate>& scatter, Estimate& estimate) {
  if (scatter.empty() || !estimate.isGiven() || estimate.isMultimodal()) {
    return;
  }
  const auto p = static_cast<Eigen::Index>(scatter.size());
  Eigen::VectorXd wide(p);
  estimate.limits = {Eigen::VectorXd(p), Eigen::VectorXd(p)};
  estimate.interval_factors = {Eigen::MatrixXd(p, 1), Eigen::MatrixXd(p, 1)};
  for (Eigen::Index i = 0; i < p; ++i) {
    const ScatterEstimate& one = scatter[static_cast<std::size_t>(i)];
    wide[i] = one.widen(estimate.stddev[i]);
    estimate.limits.lower[i] = one.bounds.lower;
    estimate.limits.upper[i] = one.bounds.upper;
    estimate.interval_factors.set(i, 0, one.calcFactor(estimate.stddev[i]));
  }
  const Eigen::VectorXd shares = estimate.stddev.cwiseQuotient(wide);
  if (estimate.correlation.size() > 0) {
    estimate.correlation = shares.asDiagonal() * estimate.correlation * shares.asDiagonal();
    estimate.correlation.diagonal().setOnes();
  }
  estimate.stddev = wide;
  estimate.draws = {};
  estimate.mixture = estimate.ridge = {};
}

void addDisagreement(const InferredMeasurement& inferred, Statuses& statuses) {
  if (!inferred.scatter.empty()) {
    statuses.insert(statuses.begin() + (isMismatch(statuses) ? 1 : 0), "trials_disagree");
  }
}

}  // namespace

Estimate selectEstimate(const InferredMeasurement& inferred) {
  Estimate estimate = isSampled(inferred) ? inferred.posterior->estimate
                      : isAccepted(inferred)
                          ? makeEstimate(*inferred.refined, inferred.by_estimator.mean.size())
                          : inferred.by_estimator;
  if (!estimate.isGiven()) {
    estimate.method = EstimationMethod::kPosterior;
  }
  widen(inferred.scatter, estimate);
  if (inferred.prior && estimate.isGiven()) {
    estimate.prior_stddev = inferred.prior->stddev.head(estimate.mean.size());
  }
  estimate.statuses = listStatuses(inferred);
  return estimate;
}

const SimulatorFit* findFit(const InferredMeasurement& inferred) {
  const PosteriorEstimate* posterior = findSimulated(inferred);
  return posterior != nullptr && posterior->fit->isSimulated() ? &*posterior->fit : nullptr;
}

Estimate makeEstimate(const Refined& refined, Eigen::Index parameters) {
  Estimate estimate{refined.mean.head(parameters), refined.stddev.head(parameters)};
  estimate.correlation = calcCorrelation(refined.covariance.topLeftCorner(parameters, parameters));
  if (refined.ridge.isGiven()) {
    estimate.ridge = takeFirst(refined.ridge, parameters);
    estimate.interval_factors = {refined.interval_factors.of50.topRows(parameters),
                                 refined.interval_factors.of95.topRows(parameters)};
  }
  estimate.method = EstimationMethod::kRefined;
  return estimate;
}

bool isEstimatorLimited(const InferredMeasurement& inferred) {
  if (isSampled(inferred) || isAccepted(inferred)) {
    return false;
  }
  const Eigen::VectorXd ratio = inferred.by_estimator.calcRatioToLimit();
  return !inferred.estimator_is_calibrated || (ratio.size() > 0 && ratio.maxCoeff() > kEstimatorLimitedRatio);
}

bool isUncalibrated(const InferredMeasurement& inferred) {
  return !isSampled(inferred) &&
         (isAccepted(inferred) ? inferred.coverage_is_short : inferred.estimator_coverage_is_short);
}

bool hasStatus(const std::vector<std::string>& statuses, Notice notice) {
  return std::find(statuses.begin(), statuses.end(), getNotice(notice).name) != statuses.end();
}

bool isMismatch(const std::vector<std::string>& statuses) {
  return !statuses.empty() && statuses.front() == toString(TrustStatus::kModelMismatch);
}

std::vector<std::string> listStatuses(const InferredMeasurement& inferred) {
  const PosteriorEstimate* posterior = findSimulated(inferred);
  if (posterior != nullptr && !posterior->fit->isSimulated() && !inferred.by_estimator.isGiven()) {
    return {"not_simulated"};
  }
  std::vector<std::string> statuses = isSampled(inferred) ? listOfSampled(inferred) : listOfOthers(inferred);
  if (inferred.posterior && inferred.posterior->isReliable() && !inferred.posterior->doubt.empty()) {
    statuses.emplace_back(inferred.posterior->getStatus());
  }
  addMissing(inferred, statuses);
  addDisagreement(inferred, statuses);
  if (statuses.empty() && (inferred.trust || posterior != nullptr)) {
    statuses.emplace_back(toString(TrustStatus::kOk));
  }
  return statuses;
}

bool misleads(const std::vector<std::string>& statuses) {
  return std::any_of(statuses.begin(), statuses.end(), [](const std::string& status) {
    return getStatus(status).severity == Severity::kMisleading;
  });
}

void dropExcuses(std::vector<std::string>& statuses) {
  const auto is_excuse = [](const std::string& status) {
    return status == "noise_coloured" || status == "sensor_offset" || status == "noise_larger" ||
           getStatus(status).concern == Concern::kNuisance;
  };
  statuses.erase(std::remove_if(statuses.begin(), statuses.end(), is_excuse), statuses.end());
}

std::string joinStatuses(const std::vector<std::string>& statuses, const char* separator) {
  std::string joined;
  for (const std::string& status : statuses) {
    joined += (joined.empty() ? "" : separator) + status;
  }
  return joined;
}

}  // namespace twinmap
