#include "framework/diagnosis/scored_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/base/text/source_location.hpp"
#include "framework/diagnosis/term_candidates.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The point of the sampled box of the first recording.
VectorXd makeSampledPoint(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                          const VectorXd& point) {
  const auto own = static_cast<Index>(experiment.model.parameters.size() + experiment.model.nuisance.size());
  VectorXd sampled(own + recordings.known.size());
  sampled << point.head(own), recordings.known;
  return sampled;
}

/// All columns but `count` from `first` on.
std::vector<Index> listOthers(Index columns, Index first, Index count) {
  std::vector<Index> others;
  for (Index i = 0; i < columns; ++i) {
    if (i < first || i >= first + count) {
      others.push_back(i);
    }
  }
  return others;
}

/// Standard deviations of parameters with the derivatives `jacobian`, each within its bounds.
VectorXd calcLinearStddevs(const MatrixXd& jacobian, const std::vector<ParameterSpec>& unknown) {
  const VectorXd half_widths = 0.5 * calcWidths(unknown);
  const MatrixXd scaled = jacobian * half_widths.asDiagonal();
  MatrixXd hessian = scaled.transpose() * scaled;
  hessian.diagonal().array() += kHalfWidthInformation;
  const MatrixXd inverse = linalg::solveCholesky(linalg::calcCholesky(hessian).lower,
                                                 MatrixXd::Identity(hessian.rows(), hessian.cols()));
  return inverse.diagonal().cwiseSqrt().cwiseProduct(half_widths);
}

/// The starts of a search: without the term, and with what its score says of all parameters.
MatrixXd makeTermStarts(const VectorXd& point, const AugmentedExperiment& augmented, Index p,
                        const TermScore& score, const TermCandidate& candidate) {
  VectorXd added(augmented.added);
  if (candidate.own_scale) {
    added[1] = candidate.own_scale->value;
  }
  added[0] = 0.0;
  MatrixXd starts(point.size() + added.size(), 2);
  starts.col(0) = insertAdded(point, p, added);
  added[0] = score.estimate;
  starts.col(1) = insertAdded(point + score.shifts, p, added);
  return starts;
}

/// sd of the coefficient, column `first` of the derivatives, and what its own scale costs.
void setTermStddevs(const LinearizedRecordings& linear, Index first, double own_scale, FittedTerm& fitted) {
  const MatrixXd& jacobian = linear.jacobian;
  const ScoreTest test(linear.residual, jacobian(Eigen::all, listOthers(jacobian.cols(), first, 1)),
                       jacobian.col(first));
  fitted.stddev = test.calcScore(0, kInfinity).stddev;
  fitted.cautious_stddev = test.calcCautiousStddev(0, linear.starts);
  if (own_scale > 0.0) {
    constexpr double kPriorStddev = 0.93;  // of the logarithm, uniform from a fifth to fivefold
    const ScoreTest of_scale(linear.residual, jacobian(Eigen::all, listOthers(jacobian.cols(), first + 1, 1)),
                             jacobian.col(first + 1));
    const TermScore score = of_scale.calcScore(0, kInfinity);
    fitted.log_evidence_of_scale =
        score.visible ? calcLogEvidence(0.0, score.stddev / own_scale, kPriorStddev) : 0.0;
  }
}

}  // namespace

void requireSystem(const ExperimentSpec& experiment) {
  if (!isGiven(experiment.model.system)) {
    throw ExperimentError(experiment.name.where, experiment.name.text,
                          "is a model from elsewhere, whose terms twinmap does not know; diagnose needs a "
                          "'system' of bodies");
  }
  if (!(experiment.model.simulation.duration > 0.0)) {
    throw ExperimentError(experiment.name.where, experiment.name.text,
                          "is not simulated in time; diagnose needs a 'simulation.duration'");
  }
}

ScoredCandidates scoreCandidates(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                 const VectorXd& point) {
  requireSystem(experiment);
  ScoredCandidates scored;
  scored.candidates = listCandidates(
      experiment.model, calcModelSizes(experiment.model, makeSampledPoint(experiment, recordings, point)));
  const AugmentedExperiment all = addAll(experiment, scored.candidates);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const RecordingsProblem problem(all.experiment, recordings);
  const LinearizedRecordings linear = problem.linearize(insertAdded(point, p, VectorXd::Zero(all.added)));
  const std::vector<Index> parameters = listOthers(linear.jacobian.cols(), p, all.added);
  std::vector<ParameterSpec> unknown;
  for (const Index i : parameters) {
    unknown.push_back(problem.getUnknown()[static_cast<std::size_t>(i)]);
  }
  const MatrixXd jacobian = linear.jacobian(Eigen::all, parameters);
  scored.test =
      std::make_unique<ScoreTest>(linear.residual, jacobian, linear.jacobian.middleCols(p, all.added));
  scored.stddevs = calcLinearStddevs(jacobian, unknown);
  for (Index k = 0; k < all.added; ++k) {
    scored.scores.push_back(scored.test->calcScore(k, scored.candidates[static_cast<std::size_t>(k)].size));
    scored.tested += scored.scores.back().visible ? 1 : 0;
  }
  return scored;
}

FittedTerm fitTerm(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const TermCandidate& candidate, const TermScore& score, const VectorXd& point) {
  // far enough for a fit that the linear model underestimates; the posterior's bounds follow from its end
  constexpr double kAbove = 10.0, kStddevs = 20.0;
  const double largest =
      std::max({candidate.size, kAbove * std::abs(score.estimate), kStddevs * score.stddev});
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
  setTermStddevs(problem.linearize(fit.point), p, candidate.own_scale ? fit.point[p + 1] : 0.0, fitted);
  if (!(fitted.stddev > 0.0)) {
    return fitted;  // the parameters, or its own scale, take it up
  }
  const double reach = std::abs(fitted.estimate) + kStddevs * fitted.stddev;
  ParameterSpec& coefficient = fitted.augmented.experiment.model.parameters[static_cast<std::size_t>(p)];
  if (reach < largest) {
    coefficient.bounds = {-reach, reach, {}};
  }
  fitted.point = fit.point;
  return fitted;
}

}  // namespace twinmap
