#include "framework/study/pipeline/select_answers.hpp"

#include <algorithm>

#include "framework/inference/select_estimate.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/exact_posteriors.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of each a mixture, where any is to be one.
void requireMixtures(Estimates& estimates) {
  for (Index i = 0; i < estimates.mean.cols() && estimates.mixtures.size() < estimates.correlations.size();
       ++i) {
    estimates.mixtures.push_back({VectorXd::Ones(1),
                                  estimates.mean.col(i),
                                  estimates.stddev.col(i),
                                  {estimates.correlations[static_cast<std::size_t>(i)]}});
  }
}

IntervalFactors calcDrawnFactors(const Estimate& one) {
  const Index p = one.mean.size();
  IntervalFactors factors{MatrixXd(p, 1), MatrixXd(p, 1)};
  for (Index j = 0; j < p; ++j) {
    factors.set(j, 0,
                calcDrawnFactor(one.draws.points.row(j), one.draws.weights, one.mean[j], one.stddev[j]));
  }
  return factors;
}

void setPosterior(const Estimate& one, std::size_t sample, Estimates& estimates) {
  const auto i = static_cast<Index>(sample);
  estimates.mean.col(i) = one.mean;
  estimates.stddev.col(i) = one.stddev;
  estimates.correlations[sample] = one.correlation;
  estimates.draws.resize(estimates.correlations.size());
  estimates.draws[sample] = one.draws;
  if (!estimates.ridges.empty()) {
    estimates.ridges[sample] = {};
  }
  if (one.isMultimodal()) {
    requireMixtures(estimates);
  }
  if (!estimates.mixtures.empty()) {
    estimates.mixtures[sample] = one.isMultimodal()
                                     ? one.mixture
                                     : Mixture{VectorXd::Ones(1), one.mean, one.stddev, {one.correlation}};
  }
  if (one.isMultimodal()) {
    estimates.interval_factors.setNormal(i);
  } else {
    setFactors(calcDrawnFactors(one), i, estimates);
  }
}

/// Mean and standard deviation of the component that is nearest to the truth, in its standard deviations.
void takeNearest(const VectorXd& truth, const Mixture& mixture, Index sample, Estimates& estimates) {
  Index nearest = 0;
  ((mixture.means.colwise() - truth).array() / mixture.stddevs.array())
      .square()
      .colwise()
      .sum()
      .minCoeff(&nearest);
  estimates.mean.col(sample) = mixture.means.col(nearest);
  estimates.stddev.col(sample) = mixture.stddevs.col(nearest);
}

}  // namespace

Estimates selectAnswers(const InferredTests& tests, const MatrixXd& residual_correlation,
                        const MatrixXd& truth) {
  Estimates estimates = selectEstimates(tests.by_estimator, residual_correlation, tests.refined);
  for (const std::size_t i : tests.sampled) {
    const PosteriorEstimate& posterior = *tests.inferred[i].posterior;
    if (posterior.isReliable()) {
      setPosterior(posterior.estimate, i, estimates);
    }
  }
  for (std::size_t i = 0; i < tests.inferred.size() && !estimates.mixtures.empty(); ++i) {
    if (isMultimodal(estimates.mixtures[i])) {
      takeNearest(truth.col(static_cast<Index>(i)), estimates.mixtures[i], static_cast<Index>(i), estimates);
    }
  }
  estimates.weights = tests.calcWeights();
  return estimates;
}

std::optional<AnswerSummary> summarizeAnswers(const InferredTests& tests) {
  if (tests.inferred.empty()) {
    return std::nullopt;
  }
  AnswerSummary summary{{}, tests.calcWeights(), tests.needing.size(), tests.sampled.size()};
  for (const InferredMeasurement& inferred : tests.inferred) {
    const Estimate answer = selectEstimate(inferred);
    summary.answers.push_back({answer.getMethod(), answer.statuses});
  }
  return summary;
}

MethodSummary summarizeSampled(const std::vector<ParameterSpec>& parameters, const MatrixXd& truth,
                               const InferredTests& tests, const Estimates& answers,
                               const MatrixXd& limit_stddev) {
  constexpr std::size_t kMin = 3;  // for a standard error
  MethodSummary summary{"sampled", static_cast<Index>(tests.sampled.size()), 0, 0, {}};
  summary.metrics.assign(parameters.size(), {});
  Estimates sampled = answers;
  sampled.weights.setZero(truth.cols());
  std::vector<int> simulations;
  for (const std::size_t i : tests.sampled) {
    const PosteriorEstimate& posterior = *tests.inferred[i].posterior;
    sampled.weights[static_cast<Index>(i)] = posterior.isReliable() ? 1.0 : 0.0;
    simulations.push_back(posterior.fit->simulations);
  }
  const auto reliable = static_cast<std::size_t>(sampled.weights.sum());
  const auto middle = simulations.begin() + static_cast<std::ptrdiff_t>(simulations.size() / 2);
  std::nth_element(simulations.begin(), middle, simulations.end());
  summary.median_simulations = *middle;
  if (reliable >= kMin) {
    summary.accepted = static_cast<Index>(reliable);
    summary.metrics = calcMetrics(parameters, truth, sampled, limit_stddev);
  }
  return summary;
}

}  // namespace twinmap
