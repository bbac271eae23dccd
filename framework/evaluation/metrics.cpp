#include "framework/evaluation/metrics.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace twinmap {
namespace {

using Eigen::ArrayXd;

/// Two-sided normal quantile: P(|z| < quantile) = probability.
double calcTwoSidedQuantile(double probability) {
  return boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + probability));
}

double calcCoverage(const ArrayXd& z, double probability) {
  return (z.abs() < calcTwoSidedQuantile(probability)).cast<double>().mean();
}

double calcStddev(const ArrayXd& values) {
  return std::sqrt((values - values.mean()).square().sum() / (static_cast<double>(values.size()) - 1.0));
}

ArrayXd calcScale(const ParameterSpec& parameter, const ArrayXd& truth) {
  if (parameter.relative_to == RelativeTo::kRange) {
    return ArrayXd::Constant(truth.size(), parameter.bounds.upper - parameter.bounds.lower);
  }
  return truth;
}

ParameterMetrics calcMetrics(const ParameterSpec& parameter, const ArrayXd& truth, const ArrayXd& mean,
                             const ArrayXd& stddev) {
  constexpr double kPercent = 100.0;
  const ArrayXd scale = calcScale(parameter, truth);
  const ArrayXd error = (mean - truth) / scale;
  const ArrayXd z = (mean - truth) / stddev;
  const double log_root_two_pi = 0.5 * std::log(boost::math::constants::two_pi<double>());
  ParameterMetrics metrics;
  metrics.bias_pct = kPercent * error.mean();
  metrics.sd_pct = kPercent * calcStddev(error);
  metrics.mare_pct = kPercent * error.abs().mean();
  metrics.coverage95 = calcCoverage(z, 0.95);
  metrics.coverage90 = calcCoverage(z, 0.90);
  metrics.coverage50 = calcCoverage(z, 0.50);
  metrics.stddev_pct = kPercent * std::sqrt((stddev / scale).square().mean());
  metrics.z_mean = z.mean();
  metrics.z_sd = calcStddev(z);
  metrics.nlpd = (0.5 * z.square() + stddev.log()).mean() + log_root_two_pi;
  metrics.samples = static_cast<int>(truth.size());
  return metrics;
}

}  // namespace

std::vector<ParameterMetrics> calcMetrics(const std::vector<ParameterSpec>& parameters,
                                          const Eigen::MatrixXd& truth, const Predictions& predictions) {
  std::vector<ParameterMetrics> metrics;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    metrics.push_back(calcMetrics(parameters[p], truth.row(row).array(), predictions.mean.row(row).array(),
                                  predictions.stddev.row(row).array()));
  }
  return metrics;
}

}  // namespace twinmap
