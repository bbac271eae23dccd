#include "framework/study/pipeline/answers.hpp"

#include <algorithm>

#include "framework/analysis/calibration.hpp"

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
  if (simulations.empty()) {
    return 0;
  }
  const auto middle = simulations.begin() + static_cast<std::ptrdiff_t>(simulations.size() / 2);
  std::nth_element(simulations.begin(), middle, simulations.end());
  return *middle;
}

/// Intervals of the answer reach as those of a refined one.
void setReach(const Refined& refined, Index sample, Predictions& predictions) {
  if (refined.reach.isGiven() && !predictions.reach.isGiven()) {
    predictions.reach = {MatrixXd::Constant(predictions.mean.rows(), predictions.mean.cols(), kNormal50),
                         MatrixXd::Constant(predictions.mean.rows(), predictions.mean.cols(), kNormal95)};
  }
  for (Index p = 0; p < predictions.mean.rows() && predictions.reach.isGiven(); ++p) {
    predictions.reach.set(p, sample, refined.reach.get(p));
  }
}

/// The mixture of the first p of its parameters.
Mixture takeFirst(Mixture mixture, Index p) {
  mixture.means = mixture.means.topRows(p).eval();
  mixture.stddevs = mixture.stddevs.topRows(p).eval();
  for (MatrixXd& correlation : mixture.correlations) {
    correlation = correlation.topLeftCorner(p, p).eval();
  }
  return mixture;
}

/// Of all samples, or of none.
MatrixXd chooseColumns(const MatrixXd& values, const std::vector<Index>& columns) {
  return values.cols() > 0 ? MatrixXd(values(Eigen::all, columns)) : MatrixXd();
}

}  // namespace

std::vector<Index> findAccepted(const std::vector<Refined>& refined) {
  std::vector<Index> accepted;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (refined[i].isAccepted()) {
      accepted.push_back(static_cast<Index>(i));
    }
  }
  return accepted;
}

Answers makeAnswers(const Predictions& map, const MatrixXd& residual_correlation,
                    const std::vector<Refined>& refined) {
  Answers answers{map, map.correlations};
  if (answers.correlations.empty()) {
    answers.correlations.assign(std::max<std::size_t>(refined.size(), 1), residual_correlation);
  }
  const Index p = map.mean.rows();
  for (const Index i : findAccepted(refined)) {
    const auto column = static_cast<std::size_t>(i);
    const Refined& one = refined[column];
    answers.predictions.mean.col(i) = one.mean.head(p);
    answers.predictions.stddev.col(i) = one.stddev.head(p);
    answers.correlations[column] = calcCorrelation(one.covariance.topLeftCorner(p, p));
    setReach(one, i, answers.predictions);
    if (one.ridge.isGiven()) {
      answers.ridges.resize(refined.size());
      answers.ridges[column] = takeFirst(one.ridge, p);
    }
    if (!map.mixtures.empty()) {
      answers.predictions.mixtures[column] = {
          VectorXd::Ones(1), one.mean.head(p), one.stddev.head(p), {answers.correlations[column]}};
    }
  }
  return answers;
}

Evaluation evaluateAnswers(const std::vector<ParameterSpec>& parameters, const MatrixXd& truth,
                           const Answers& answers, const MatrixXd& limit_stddev) {
  Evaluation evaluation;
  evaluation.truth = truth;
  evaluation.predictions = answers.predictions;
  evaluation.limit_stddev = limit_stddev;
  evaluation.metrics = calcMetrics(parameters, truth, answers.predictions, limit_stddev);
  evaluation.joint = calcJointMetrics(truth, answers.predictions, answers.correlations);
  const MatrixXd pit = calcPit(truth, answers.predictions);
  for (const auto& row : pit.rowwise()) {
    evaluation.pit_counts.push_back(countPit(row.transpose()));
  }
  return evaluation;
}

MethodSummary summarizeMap(const std::string& name, const std::vector<ParameterSpec>& parameters,
                           const MatrixXd& truth, const Predictions& predictions,
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
  Predictions predictions{MatrixXd(truth.rows(), summary.accepted), MatrixXd(truth.rows(), summary.accepted)};
  for (Index i = 0; i < summary.accepted; ++i) {
    const Refined& one = refined[static_cast<std::size_t>(accepted[static_cast<std::size_t>(i)])];
    predictions.mean.col(i) = one.mean.head(truth.rows());
    predictions.stddev.col(i) = one.stddev.head(truth.rows());
    setReach(one, i, predictions);
  }
  summary.metrics = calcMetrics(parameters, chooseColumns(truth, accepted), predictions,
                                chooseColumns(limit_stddev, accepted));
  return summary;
}

}  // namespace twinmap
