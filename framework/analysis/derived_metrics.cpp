#include "framework/analysis/derived_metrics.hpp"

#include <cmath>

#include "framework/analysis/calibration.hpp"
#include "framework/analysis/sample_terms.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One of n estimates.
Estimate takeEstimate(const Estimates& estimates, Index sample) {
  const auto i = static_cast<std::size_t>(sample);
  Estimate estimate{estimates.mean.col(sample), estimates.stddev.col(sample)};
  estimate.correlation =
      estimates.correlations.size() == 1 ? estimates.correlations.front() : estimates.correlations[i];
  if (!estimates.mixtures.empty()) {
    estimate.mixture = estimates.mixtures[i];
  }
  if (!estimates.draws.empty()) {
    estimate.draws = estimates.draws[i];
  }
  if (!estimates.ridges.empty()) {
    estimate.ridge = estimates.ridges[i];
  }
  const IntervalFactors& factors = estimates.interval_factors;
  if (factors.isGiven()) {
    const Index column = factors.of95.cols() == 1 ? 0 : sample;
    estimate.interval_factors = {factors.of50.col(column), factors.of95.col(column)};
  }
  return estimate;
}

std::vector<ValueDistribution> propagate(const DerivedQuantities& quantities, const Estimate& estimate) {
  const BoundedDraws& draws = estimate.draws;
  if (!draws.isGiven()) {
    return quantities.propagate(estimate);
  }
  const MatrixXd values = quantities.calcAll(draws.points.topRows(quantities.countParameters()));
  std::vector<ValueDistribution> distributions;
  for (const auto& of_quantity : values.rowwise()) {
    distributions.emplace_back(of_quantity.transpose(), draws.weights);
  }
  return distributions;
}

ParameterSamples takeQuantity(const DerivedEvaluation& evaluation, Index k) {
  const Index n = evaluation.truth.cols();
  return {evaluation.truth.row(k),
          evaluation.mean.row(k),
          evaluation.stddev.row(k),
          evaluation.limit_stddev.size() > 0 ? Eigen::ArrayXd(evaluation.limit_stddev.row(k).transpose())
                                             : Eigen::ArrayXd::Constant(n, std::nan("")),
          {},
          Eigen::ArrayXd(n),
          {}};
}

}  // namespace

DerivedEvaluation evaluateDerived(const DerivedQuantities& quantities, const MatrixXd& truths,
                                  const Estimates& estimates, const MatrixXd& limits) {
  const MatrixXd truth = estimates.repeat(truths), limit_stddev = estimates.repeat(limits);
  const Index q = quantities.count(), n = truth.cols();
  DerivedEvaluation result{quantities.getSpecs(), quantities.calcAll(truth),
                           MatrixXd(q, n),        MatrixXd(q, n),
                           MatrixXd(q, n),        MatrixXd(q, n),
                           limit_stddev};
  MatrixXd z(q, n);
  std::vector<IntervalFactor> factors;
  for (Index i = 0; i < n; ++i) {
    const Estimate estimate = takeEstimate(estimates, i);
    const auto distributions = propagate(quantities, estimate);
    factors.push_back(estimate.draws.isGiven() ? IntervalFactor{} : findLargestFactor(estimate));
    const DerivedEstimate derived = summarize(distributions, factors.back().of95);
    result.mean.col(i) = derived.mean;
    result.stddev.col(i) = derived.stddev;
    result.lower95.col(i) = derived.lower95;
    result.upper95.col(i) = derived.upper95;
    for (Index k = 0; k < q; ++k) {
      const double below = distributions[static_cast<std::size_t>(k)].calcProbability(result.truth(k, i));
      z(k, i) = -calcNormalQuantile(below);
    }
  }
  for (Index k = 0; k < q; ++k) {
    ParameterSamples samples = takeQuantity(result, k);
    samples.z = z.row(k).transpose().array();
    samples.factors = factors;
    samples.weights = estimates.weights;
    samples.repeated = estimates.repeated;
    result.metrics.push_back(calcMetrics(result.quantities[static_cast<std::size_t>(k)], samples));
  }
  for (MatrixXd* values : {&result.truth, &result.mean, &result.stddev, &result.lower95, &result.upper95}) {
    values->conservativeResize(Eigen::NoChange, truths.cols());
  }
  result.limit_stddev = limits;
  return result;
}

MatrixXd calcDerivedLimit(const DerivedQuantities& quantities, const std::vector<ParameterSpec>& parameters,
                          const MatrixXd& points, const InformationLimit& limit) {
  const VectorXd widths = calcWidths(parameters);
  MatrixXd stddev = MatrixXd::Constant(quantities.count(), points.cols(), std::nan(""));
  if (quantities.count() == 0) {
    return stddev;  // names of nothing have no places for parameters
  }
  for (Index i = 0; i < points.cols(); ++i) {
    const auto sample = static_cast<std::size_t>(i);
    if (limit.information[sample].size() > 0) {
      const MatrixXd gradients = quantities.calcGradients(points.col(i)) * widths.asDiagonal();
      stddev.col(i) =
          (gradients * limit.calcCovariance(sample) * gradients.transpose()).diagonal().cwiseSqrt();
    }
  }
  return stddev;
}

}  // namespace twinmap
