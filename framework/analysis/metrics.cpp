#include "framework/analysis/metrics.hpp"

#include "framework/analysis/jackknife.hpp"
#include "framework/analysis/sample_terms.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

void setFigures(const VectorXd& values, ParameterFigures& figures) {
  for (std::size_t i = 0; i < kFigureColumns.size(); ++i) {
    figures.*kFigureColumns[i].value = values[static_cast<Index>(i)];
  }
}

}  // namespace

ParameterMetrics calcMetrics(const ParameterSpec& parameter, const ParameterSamples& samples, int draws) {
  const SampleTerms terms = calcSampleTerms(parameter, samples);
  const JackknifeFigures estimates = calcWithJackknife(
      terms.terms, [&](const VectorXd& mean, double count) { return calcFigureValues(terms, mean, count); },
      draws);
  ParameterMetrics metrics;
  setFigures(estimates.value, metrics);
  setFigures(estimates.standard_error, metrics.se);
  metrics.samples = static_cast<int>(samples.weights.size() > 0
                                         ? (samples.weights.head(samples.count()).array() > 0.0).count()
                                         : samples.count());
  return metrics;
}

std::vector<ParameterMetrics> calcMetrics(const std::vector<ParameterSpec>& parameters,
                                          const Eigen::MatrixXd& truth, const Estimates& predictions,
                                          const Eigen::MatrixXd& limit_stddev, int draws) {
  std::vector<ParameterMetrics> metrics;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    metrics.push_back(calcMetrics(
        parameters[p], takeParameter(truth, predictions, limit_stddev, static_cast<Index>(p)), draws));
  }
  return metrics;
}

}  // namespace twinmap
