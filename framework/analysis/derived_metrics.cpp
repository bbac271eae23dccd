#include "framework/analysis/derived_metrics.hpp"

#include <cmath>

#include "framework/analysis/calibration.hpp"
#include "framework/analysis/sample_terms.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool isRidge(const std::vector<Mixture>& ridges, Index sample) {
  return !ridges.empty() && ridges[static_cast<std::size_t>(sample)].isGiven();
}

std::vector<ValueDistribution> propagateSample(const DerivedQuantities& quantities,
                                               const Predictions& predictions,
                                               const std::vector<MatrixXd>& correlations,
                                               const std::vector<Mixture>& ridges, Index sample) {
  const auto i = static_cast<std::size_t>(sample);
  if (isRidge(ridges, sample)) {
    return quantities.propagate(ridges[i]);
  }
  if (!predictions.mixtures.empty()) {
    return quantities.propagate(predictions.mixtures[i]);
  }
  const MatrixXd& correlation = correlations.size() == 1 ? correlations.front() : correlations[i];
  const auto stddev = predictions.stddev.col(sample).asDiagonal();
  return quantities.propagate(predictions.mean.col(sample), stddev * correlation * stddev);
}

Reach findFarthest(const IntervalReach& reach, Index sample) {
  Reach farthest;
  for (Index p = 0; p < reach.of95.rows(); ++p) {
    const Reach one = reach.get(p, reach.of95.cols() == 1 ? 0 : sample);
    farthest = one.of95 > farthest.of95 ? one : farthest;
  }
  return farthest;
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

DerivedEvaluation evaluateDerived(const DerivedQuantities& quantities, const MatrixXd& truth,
                                  const Predictions& predictions, const std::vector<MatrixXd>& correlations,
                                  const std::vector<Mixture>& ridges, const MatrixXd& limit_stddev) {
  const Index q = quantities.count(), n = truth.cols();
  DerivedEvaluation result{quantities.getSpecs(), quantities.calcAll(truth),
                           MatrixXd(q, n),        MatrixXd(q, n),
                           MatrixXd(q, n),        MatrixXd(q, n),
                           limit_stddev};
  MatrixXd z(q, n);
  std::vector<Reach> reaches;
  for (Index i = 0; i < n; ++i) {
    const auto distributions = propagateSample(quantities, predictions, correlations, ridges, i);
    const Reach reach = isRidge(ridges, i) ? Reach{} : findFarthest(predictions.reach, i);
    const DerivedEstimate estimate = summarize(distributions, reach.of95);
    result.mean.col(i) = estimate.mean;
    result.stddev.col(i) = estimate.stddev;
    result.lower95.col(i) = estimate.lower95;
    result.upper95.col(i) = estimate.upper95;
    for (Index k = 0; k < q; ++k) {
      const double below = distributions[static_cast<std::size_t>(k)].calcProbability(result.truth(k, i));
      z(k, i) = -calcNormalQuantile(below);
    }
    if (predictions.reach.isGiven()) {
      reaches.push_back(reach);
    }
  }
  for (Index k = 0; k < q; ++k) {
    ParameterSamples samples = takeQuantity(result, k);
    samples.z = z.row(k).transpose().array();
    samples.reaches = reaches;
    result.metrics.push_back(calcMetrics(result.quantities[static_cast<std::size_t>(k)], samples));
  }
  return result;
}

MatrixXd calcDerivedLimit(const DerivedQuantities& quantities, const std::vector<ParameterSpec>& parameters,
                          const MatrixXd& points, const InformationLimit& limit) {
  const VectorXd widths = calcWidths(parameters);
  MatrixXd stddev = MatrixXd::Constant(quantities.count(), points.cols(), std::nan(""));
  for (Index i = 0; i < points.cols(); ++i) {
    const MatrixXd& information = limit.information[static_cast<std::size_t>(i)];
    if (information.size() > 0) {
      const MatrixXd gradients = quantities.calcGradients(points.col(i)) * widths.asDiagonal();
      stddev.col(i) =
          (gradients * calcLimitCovariance(information) * gradients.transpose()).diagonal().cwiseSqrt();
    }
  }
  return stddev;
}

}  // namespace twinmap
