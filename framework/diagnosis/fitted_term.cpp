#include "framework/diagnosis/fitted_term.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The starts of a search: without the term, and with what its score says of all parameters.
MatrixXd makeTermStarts(const VectorXd& point, const AugmentedExperiment& augmented, Index p,
                        const TermScore& score, const TermCandidate& candidate) {
  MatrixXd starts(point.size() + augmented.added, 2);
  starts.col(0) = insertAdded(point, p, candidate.listValues(0.0));
  starts.col(1) = insertAdded(point + score.shifts, p, candidate.listValues(score.estimate));
  return starts;
}

/// The sd of a scale's prior, which is uniform in its logarithm.
double calcPriorStddev(const OwnScale& scale, double value) {
  return value * std::log(scale.reach) / std::sqrt(3.0);
}

/// What the freedom of a scale in column `at` of the derivatives costs in evidence. Those of its term before
/// it, from `first` on, are given. So the product over a term's coefficient and scales is the volume of all
/// together, whatever their correlation.
double calcScaleEvidence(const LinearizedRecordings& linear, Index first, Index at, double prior_stddev) {
  const ScoreTest test(linear.residual,
                       linear.jacobian(Eigen::all, listOthers(linear.jacobian.cols(), first, at - first + 1)),
                       linear.jacobian.col(at));
  const TermScore score = test.calcScore(0, kInfinity);
  return score.visible ? std::log(std::min(1.0, score.stddev / prior_stddev)) : 0.0;
}

/// sd of the coefficient, column `first` of the derivatives, and what its own scales cost.
void setTermStddevs(const LinearizedRecordings& recorded, Index first, const TermCandidate& candidate,
                    FittedTerm& fitted) {
  const LinearizedRecordings linear = addScalePriors(recorded, first, candidate, fitted.point);
  const MatrixXd& jacobian = linear.jacobian;
  const ScoreTest test(linear.residual, jacobian(Eigen::all, listOthers(jacobian.cols(), first, 1)),
                       jacobian.col(first));
  fitted.stddev = test.calcScore(0, kInfinity).stddev;
  fitted.cautious_stddev = test.calcCautiousStddev(0, linear.starts);
  fitted.log_evidence_of_scales = calcScalesEvidence(linear, first, candidate, fitted.point);
}

}  // namespace

LinearizedRecordings addScalePriors(const LinearizedRecordings& linear, Index first,
                                    const TermCandidate& candidate, const VectorXd& point) {
  const auto scales = static_cast<Index>(candidate.own_scales.size());
  const Index n = linear.residual.size(), u = linear.jacobian.cols();
  LinearizedRecordings all{VectorXd::Zero(n + scales), MatrixXd::Zero(n + scales, u), linear.starts};
  all.residual.head(n) = linear.residual;
  all.jacobian.topRows(n) = linear.jacobian;
  for (Index i = 0; i < scales; ++i) {
    const Index at = first + 1 + i;
    const OwnScale& scale = candidate.own_scales[static_cast<std::size_t>(i)];
    all.jacobian(n + i, at) = 1.0 / calcPriorStddev(scale, point[at]);
    all.starts.push_back(n + i);
  }
  return all;
}

double calcScalesEvidence(const LinearizedRecordings& linear, Index first, const TermCandidate& candidate,
                          const VectorXd& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < candidate.own_scales.size(); ++i) {
    const Index at = first + 1 + static_cast<Index>(i);
    sum += calcScaleEvidence(linear, first, at, calcPriorStddev(candidate.own_scales[i], point[at]));
  }
  return sum;
}

FittedTerm fitTerm(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const TermCandidate& candidate, const TermScore& score, const VectorXd& point) {
  // the posterior's bounds follow from the fit's end
  const double largest =
      std::max(candidate.size, kAboveScore * std::max(std::abs(score.estimate), score.stddev));
  FittedTerm fitted;
  fitted.augmented = addTerm(experiment, candidate, largest);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const RecordingsProblem problem(fitted.augmented.experiment, recordings);
  const RecordingFit fit = problem.fit(makeTermStarts(point, fitted.augmented, p, score, candidate));
  if (fit.point.size() == 0) {
    return fitted;
  }
  fitted.chi_square = fit.chi_square;
  fitted.estimate = fit.point[p];
  fitted.point = fit.point;
  setTermStddevs(problem.linearize(fit.point), p, candidate, fitted);
  if (!(fitted.stddev > 0.0)) {
    fitted.point.resize(0);
    return fitted;  // the parameters, or its own scale, take it up
  }
  const double reach = std::abs(fitted.estimate) + kAboveScore * fitted.stddev;
  if (reach < largest && !candidate.is_share) {
    setBounds(static_cast<std::size_t>(p), {-reach, reach, {}}, fitted.augmented.experiment);
  }
  return fitted;
}

}  // namespace twinmap
