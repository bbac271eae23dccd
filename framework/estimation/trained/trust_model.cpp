#include "framework/estimation/trained/trust_model.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "framework/estimation/estimate.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kFarAway = 1.5;  // times the reach of simulated measurements

bool liesBeyondBounds(const TrustModel& model, const VectorXd& mean) {
  const Index p = mean.size();
  return ((mean - model.center.head(p)).array().abs() > model.half_width.head(p).array()).any();
}

VectorXd calcPriorStddev(const TrustModel& model, Index p) {
  return model.prior.stddev.head(p).cwiseProduct(model.half_width.head(p));
}

/// All that apply to an estimate, by the p-value and the distance found.
void setStatuses(const TrustModel& model, const VectorXd& mean, const VectorXd& stddev, Trust& trust) {
  trust.statuses.clear();
  if (trust.p_value < model.level) {
    trust.statuses.push_back(TrustStatus::kModelMismatch);
  }
  if (trust.distance > kFarAway) {
    trust.statuses.push_back(TrustStatus::kOutsideTraining);
  }
  if (liesBeyondBounds(model, mean)) {
    trust.statuses.push_back(TrustStatus::kAtBounds);
  }
  if (isUninformative(stddev, calcPriorStddev(model, stddev.size()))) {
    trust.statuses.push_back(TrustStatus::kUninformative);
  }
  if (trust.statuses.empty()) {
    trust.statuses.push_back(TrustStatus::kOk);
  }
}

/// Residual, chi-square and anomaly, without their p-values.
void setResidual(const TrustModel& model, const VectorXd& residual, Trust& trust) {
  trust.chi_square = residual.squaredNorm();
  trust.residuals = residual.size();
  trust.anomaly = findAnomaly(residual, model.runs);
}

void combinePValues(Trust& trust) {
  trust.p_value = std::min(1.0, 2.0 * std::min(trust.chi_square_p_value, trust.anomaly_p_value));
}

/// How rare it is that the simulator explains nothing of a simulated measurement. The level of false alarms
/// is shared between explained and unexplained ones. Each unexplained one is an alarm if these are rarer than
/// half of the level. Otherwise half of the level is theirs, the worst of them.
class UnexplainedShare {
 public:
  explicit UnexplainedShare(const TrustModel& model)
      : reference_(model.refinement),
        all_(calcShareAbove(-std::numeric_limits<double>::infinity())),
        rare_(all_ <= kShareOfLevel * model.level),
        level_(model.level) {}

  /// Whether enough were refined that the worst of all would be an alarm.
  bool isKnown() const { return rare_ || calcPValue(std::numeric_limits<double>::infinity()) < level_; }
  double getFactorOfExplained() const { return 1.0 / (1.0 - (rare_ ? all_ / level_ : kShareOfLevel)); }
  double calcPValue(double reduced_chi_square) const {
    const double share = calcShareAbove(reduced_chi_square);
    return rare_ ? share : std::min(1.0, share / kShareOfLevel);
  }

 private:
  static constexpr double kShareOfLevel = 0.5;

  /// Of simulated measurements those that are unexplained and at least as bad; half a measurement more, for
  /// none of a few says little.
  double calcShareAbove(double reduced_chi_square) const {
    const VectorXd& sorted = reference_.unexplained;
    const double* end = sorted.data() + sorted.size();
    const auto above = static_cast<double>(end - std::lower_bound(sorted.data(), end, reduced_chi_square));
    return (above + 0.5) / (static_cast<double>(reference_.tried) + 1.0);
  }

  const RefinementReference& reference_;
  double all_;
  bool rare_;
  double level_;
};

/// Of the refined answer where there is one; else the map's stay, but for the mismatch.
void replaceStatuses(const TrustModel& model, const SimulatorResidual& found, Trust& trust) {
  if (found.mean.size() > 0) {
    setStatuses(model, found.mean, found.stddev, trust);
    return;
  }
  std::vector<TrustStatus> kept;
  if (trust.p_value < model.level) {
    kept.push_back(TrustStatus::kModelMismatch);
  }
  for (const TrustStatus status : trust.statuses) {
    if (status != TrustStatus::kModelMismatch && status != TrustStatus::kOk) {
      kept.push_back(status);
    }
  }
  trust.statuses = kept.empty() ? std::vector<TrustStatus>{TrustStatus::kOk} : kept;
}

/// The inferred parameters, or the likeliest of several, the prior's mean of the nuisance parameters, the
/// known inputs; normalised.
void makeStart(const TrustModel& model, const Eigen::Ref<const VectorXd>& known, const Estimate& estimate,
               VectorXd& start) {
  start = model.center;
  start.head(estimate.mean.size()) = estimate.takeLikeliest().mean;
  start.tail(known.size()) = known;
  start = (start - model.center).cwiseQuotient(model.half_width);
  const Index nuisance = model.unknown - estimate.mean.size();
  start.segment(estimate.mean.size(), nuisance) = model.prior.mean.tail(nuisance);
}

const ScoreExplanation& explain(const TrustModel& model, const Eigen::Ref<const VectorXd>& known,
                                const Estimate& estimate, TrustWorkspace& workspace) {
  makeStart(model, known, estimate, workspace.start);
  workspace.scores.noalias() = model.forward->projection * workspace.centered;
  return workspace.inversion.explain(workspace.scores, workspace.start.tail(known.size()),
                                     workspace.start.head(model.unknown));
}

}  // namespace

const char* toString(TrustStatus status) {
  switch (status) {
    case TrustStatus::kModelMismatch:
      return "model_mismatch";
    case TrustStatus::kOutsideTraining:
      return "outside_training";
    case TrustStatus::kAtBounds:
      return "at_bounds";
    case TrustStatus::kUninformative:
      return "uninformative";
    case TrustStatus::kOk:
      break;
  }
  return "ok";
}

double ReferenceDistribution::calcPValue(double value) const {
  const double* end = sorted.data() + sorted.size();
  const auto above = static_cast<double>(end - std::lower_bound(sorted.data(), end, value));
  return (above + 1.0) / (static_cast<double>(sorted.size()) + 1.0);
}

double TrainingCloud::calcDistance(const Eigen::Ref<const VectorXd>& at, VectorXd& buffer) const {
  buffer = at.cwiseQuotient(scale);
  return std::sqrt((inputs.colwise() - buffer).colwise().squaredNorm().minCoeff()) / reach;
}

Trust judge(const TrustModel& model, const Eigen::Ref<const VectorXd>& features,
            const Eigen::Ref<const VectorXd>& known, const Estimate& estimate,
            const ScoreExplanation* explained, TrustWorkspace& workspace) {
  workspace.centered = features - model.forward->center;
  workspace.explanation = explained != nullptr ? explained : &explain(model, known, estimate, workspace);
  model.space.calcResidual(workspace.centered, workspace.explanation->innovation, workspace.residual);
  Trust trust;
  compareWithSimulated(model, workspace.residual, trust);
  trust.distance = model.cloud.calcDistance(estimate.inputs, workspace.distance);
  const Estimate likeliest = estimate.takeLikeliest();
  setStatuses(model, likeliest.mean, likeliest.stddev, trust);
  return trust;
}

void compareWithSimulated(const TrustModel& model, const VectorXd& residual, Trust& trust) {
  setResidual(model, residual, trust);
  trust.chi_square_p_value = model.chi_square.calcPValue(trust.chi_square);
  trust.anomaly_p_value = model.anomaly.calcPValue(trust.anomaly.score);
  combinePValues(trust);
  trust.smallest_p_value = 2.0 / (static_cast<double>(model.chi_square.sorted.size()) + 1.0);
}

Trust judgeAnew(const TrustModel& model, const Trust& trust, const SimulatorResidual& found) {
  const UnexplainedShare share(model);
  if (found.residual.size() == 0 && !share.isKnown()) {
    return trust;
  }
  Trust anew = trust;
  anew.smallest_p_value =
      found.explained ? 0.0 : 2.0 * share.calcPValue(std::numeric_limits<double>::infinity());
  if (found.residual.size() > 0) {
    setResidual(model, found.residual, anew);
    anew.anomaly_p_value = model.noise_anomaly.calcPValue(anew.anomaly.score);
    anew.chi_square_p_value =
        boost::math::cdf(boost::math::complement(boost::math::chi_squared(found.degrees), anew.chi_square));
  }
  if (found.explained || !share.isKnown()) {
    combinePValues(anew);
    anew.p_value = std::min(1.0, anew.p_value * share.getFactorOfExplained());
  } else {
    anew.p_value = share.calcPValue(found.reduced_chi_square);
  }
  replaceStatuses(model, found, anew);
  return anew;
}

}  // namespace twinmap
