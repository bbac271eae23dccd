#include "framework/study/pipeline/select_answers.hpp"

#include <algorithm>

#include "framework/inference/select_estimate.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/exact_posteriors.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Mixture makeNormal(const VectorXd& mean, const VectorXd& stddev, const MatrixXd& correlation) {
  return {VectorXd::Ones(1), mean, stddev, {correlation}};
}

/// Of each a mixture, where any is to be one.
void requireMixtures(Estimates& estimates) {
  for (std::size_t i = estimates.mixtures.size(); i < estimates.correlations.size(); ++i) {
    const auto column = static_cast<Index>(i);
    estimates.mixtures.push_back(
        makeNormal(estimates.mean.col(column), estimates.stddev.col(column), estimates.correlations[i]));
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
    estimates.mixtures[sample] =
        one.isMultimodal() ? one.mixture : makeNormal(one.mean, one.stddev, one.correlation);
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

/// The columns of others that are repeated, behind those of all.
void append(const Estimates& others, Estimates& estimates) {
  const auto more = static_cast<Index>(estimates.repeated.size());
  const Index n = estimates.mean.cols();
  estimates.mean.conservativeResize(Eigen::NoChange, n + more);
  estimates.stddev.conservativeResize(Eigen::NoChange, n + more);
  IntervalFactors& factors = estimates.interval_factors;
  for (MatrixXd* values : {&factors.of50, &factors.of95}) {
    values->conservativeResize(Eigen::NoChange, values->cols() > 0 ? n + more : 0);
  }
  for (Index k = 0; k < more; ++k) {
    const Index i = estimates.repeated[static_cast<std::size_t>(k)];
    const auto sample = static_cast<std::size_t>(i);
    estimates.mean.col(n + k) = others.mean.col(i);
    estimates.stddev.col(n + k) = others.stddev.col(i);
    estimates.correlations.push_back(others.correlations[sample]);
    for (Index p = 0; p < estimates.mean.rows() && factors.isGiven(); ++p) {
      factors.set(p, n + k, others.interval_factors.get(p, i));
    }
    if (!estimates.mixtures.empty()) {
      estimates.mixtures.push_back(
          others.mixtures.empty()
              ? makeNormal(others.mean.col(i), others.stddev.col(i), others.correlations[sample])
              : others.mixtures[sample]);
    }
    if (!estimates.ridges.empty()) {
      estimates.ridges.push_back(others.ridges[sample]);
    }
    if (!estimates.draws.empty()) {
      estimates.draws.emplace_back();
    }
  }
}

/// Those that were sampled stand for the others.
void setStrataWeights(const NeedingTests& tests, VectorXd& weights) {
  for (const std::size_t i : tests.all) {
    weights[static_cast<Index>(i)] = 0.0;
  }
  for (const std::size_t i : tests.sampled) {
    weights[static_cast<Index>(i)] = tests.calcWeight();
  }
}

/// What the others of an estimate's answers are to figures: those that need a posterior and were not sampled
/// are left out, but for the refined ones that are near. These stand for themselves, and
/// those that were sampled tell by how much figures of the one kind and of the other differ.
void setWeights(const InferredTests& tests, const Estimates& refined, Estimates& estimates) {
  const auto n = static_cast<Index>(tests.inferred.size());
  estimates.weights = VectorXd::Ones(n);
  setStrataWeights(tests.elsewhere, estimates.weights);
  if (tests.near.sampled.size() < tests.near.all.size()) {
    const double weight = tests.near.calcWeight();
    for (const std::size_t i : tests.near.sampled) {
      estimates.repeated.push_back(static_cast<Index>(i));
      estimates.weights[static_cast<Index>(i)] = weight;
    }
    const auto more = static_cast<Index>(estimates.repeated.size());
    estimates.weights.conservativeResize(n + more);
    estimates.weights.tail(more).setConstant(1.0 - weight);
  }
  append(refined, estimates);
}

}  // namespace

Estimates selectAnswers(const InferredTests& tests, const MatrixXd& residual_correlation,
                        const MatrixXd& truth) {
  const Estimates refined = selectEstimates(tests.by_estimator, residual_correlation, tests.refined);
  Estimates estimates = refined;
  const std::vector<std::size_t> sampled = tests.listSampled();
  for (const std::size_t i : sampled) {
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
  if (sampled.size() < tests.countNeeding()) {
    setWeights(tests, refined, estimates);
  }
  return estimates;
}

std::optional<AnswerSummary> summarizeAnswers(const InferredTests& tests) {
  if (tests.inferred.empty()) {
    return std::nullopt;
  }
  AnswerSummary summary{{},
                        VectorXd::Ones(static_cast<Index>(tests.inferred.size())),
                        tests.countNeeding(),
                        tests.listSampled().size()};
  setStrataWeights(tests.elsewhere, summary.weights);
  setStrataWeights(tests.near, summary.weights);
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
  const std::vector<std::size_t> chosen = tests.listSampled();
  MethodSummary summary{"sampled", static_cast<Index>(chosen.size()), 0, 0, {}};
  summary.metrics.assign(parameters.size(), {});
  Estimates sampled = answers;
  sampled.weights.setZero(answers.mean.cols());
  std::vector<int> simulations;
  for (const std::size_t i : chosen) {
    const PosteriorEstimate& posterior = *tests.inferred[i].posterior;
    sampled.weights[static_cast<Index>(i)] = posterior.isReliable() ? 1.0 : 0.0;
    simulations.push_back(posterior.fit->simulations);
  }
  const auto reliable = static_cast<std::size_t>(sampled.weights.sum());
  summary.median_simulations = calcMedian(std::move(simulations));
  if (reliable >= kMin) {
    summary.accepted = static_cast<Index>(reliable);
    summary.metrics = calcMetrics(parameters, truth, sampled, limit_stddev);
  }
  return summary;
}

}  // namespace twinmap
