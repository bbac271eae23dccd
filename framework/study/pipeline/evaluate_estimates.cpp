#include "framework/study/pipeline/evaluate_estimates.hpp"

#include <algorithm>

#include "framework/analysis/calibration.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

int calcMedianSimulations(const std::vector<Refined>& refined) {
  std::vector<int> simulations;
  for (const Refined& one : refined) {
    simulations.push_back(one.simulations);
  }
  return calcMedian(std::move(simulations));
}

/// Of all samples, or of none.
MatrixXd chooseColumns(const MatrixXd& values, const std::vector<Index>& columns) {
  return values.cols() > 0 ? MatrixXd(values(Eigen::all, columns)) : MatrixXd();
}

}  // namespace

void setFactors(const IntervalFactors& of_one, Index sample, Estimates& estimates) {
  IntervalFactors& factors = estimates.interval_factors;
  if (of_one.isGiven() && !factors.isGiven()) {
    factors = {MatrixXd::Constant(estimates.mean.rows(), estimates.mean.cols(), kNormal50),
               MatrixXd::Constant(estimates.mean.rows(), estimates.mean.cols(), kNormal95)};
  }
  for (Index p = 0; p < estimates.mean.rows() && factors.isGiven(); ++p) {
    factors.set(p, sample, of_one.get(p));
  }
}

std::vector<Index> findAccepted(const std::vector<Refined>& refined) {
  std::vector<Index> accepted;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (refined[i].isAccepted()) {
      accepted.push_back(static_cast<Index>(i));
    }
  }
  return accepted;
}

Estimates selectEstimates(Estimates by_estimator, const MatrixXd& residual_correlation,
                          const std::vector<Refined>& refined) {
  Estimates estimates = std::move(by_estimator);
  if (estimates.correlations.empty()) {
    estimates.correlations.assign(std::max<std::size_t>(refined.size(), 1), residual_correlation);
  }
  const Index p = estimates.mean.rows();
  for (const Index i : findAccepted(refined)) {
    const auto column = static_cast<std::size_t>(i);
    const Refined& one = refined[column];
    estimates.mean.col(i) = one.mean.head(p);
    estimates.stddev.col(i) = one.stddev.head(p);
    estimates.correlations[column] = calcCorrelation(one.covariance.topLeftCorner(p, p));
    setFactors(one.interval_factors, i, estimates);
    if (one.ridge.isGiven()) {
      estimates.ridges.resize(refined.size());
      estimates.ridges[column] = takeFirst(one.ridge, p);
    }
    if (!estimates.mixtures.empty()) {
      estimates.mixtures[column] = {
          VectorXd::Ones(1), one.mean.head(p), one.stddev.head(p), {estimates.correlations[column]}};
    }
  }
  return estimates;
}

Evaluation evaluateEstimates(const std::vector<ParameterSpec>& parameters, const MatrixXd& truth,
                             Estimates estimates, const MatrixXd& limit_stddev) {
  Evaluation evaluation;
  evaluation.truth = truth;
  evaluation.limit_stddev = limit_stddev;
  evaluation.metrics = calcMetrics(parameters, truth, estimates, limit_stddev);
  evaluation.joint = calcJointMetrics(truth, estimates);
  const MatrixXd pit = calcPit(truth, estimates);
  for (const auto& row : pit.rowwise()) {
    evaluation.pit_counts.push_back(countPit(row.transpose(), estimates.weights));
  }
  evaluation.predictions = std::move(estimates);
  return evaluation;
}

MethodSummary summarizeMap(const std::string& name, const std::vector<ParameterSpec>& parameters,
                           const MatrixXd& truth, const Estimates& predictions,
                           const MatrixXd& limit_stddev) {
  const Index n = truth.cols();
  return {name, n, n, 0, calcMetrics(parameters, truth, predictions, limit_stddev)};
}

MethodSummary summarizeRefined(const std::vector<ParameterSpec>& parameters, const MatrixXd& truth,
                               const std::vector<Refined>& refined, const MatrixXd& limit_stddev) {
  constexpr std::size_t kMin = 3;  // for a standard error
  const std::vector<Index> accepted = findAccepted(refined);
  MethodSummary summary{
      "refined", truth.cols(), static_cast<Index>(accepted.size()), calcMedianSimulations(refined), {}};
  if (accepted.size() < kMin) {
    summary.metrics.assign(parameters.size(), {});
    return summary;
  }
  Estimates predictions{MatrixXd(truth.rows(), summary.accepted), MatrixXd(truth.rows(), summary.accepted)};
  for (Index i = 0; i < summary.accepted; ++i) {
    const Refined& one = refined[static_cast<std::size_t>(accepted[static_cast<std::size_t>(i)])];
    predictions.mean.col(i) = one.mean.head(truth.rows());
    predictions.stddev.col(i) = one.stddev.head(truth.rows());
    setFactors(one.interval_factors, i, predictions);
  }
  summary.metrics = calcMetrics(parameters, chooseColumns(truth, accepted), predictions,
                                chooseColumns(limit_stddev, accepted));
  return summary;
}

std::vector<MethodSummary> summarizeMethods(const std::string& name,
                                            const std::vector<ParameterSpec>& parameters,
                                            const MatrixXd& truth, const Estimates& by_estimator,
                                            const std::vector<Refined>& refined,
                                            const MatrixXd& limit_stddev) {
  std::vector<MethodSummary> methods{summarizeMap(name, parameters, truth, by_estimator, limit_stddev)};
  if (!refined.empty()) {
    methods.push_back(summarizeRefined(parameters, truth, refined, limit_stddev));
  }
  return methods;
}

}  // namespace twinmap
