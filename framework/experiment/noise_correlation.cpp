#include "framework/experiment/noise_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {

Eigen::VectorXd calcAutocorrelation(const NoiseCorrelationSpec& spec, Eigen::Index lags) {
  if (!spec.autoregression.empty()) {
    return calcAutocorrelation(spec.autoregression, lags);
  }
  Eigen::VectorXd rho = Eigen::VectorXd::Zero(lags + 1);
  const Eigen::Index given = std::min(lags + 1, static_cast<Eigen::Index>(spec.values.size()));
  rho.head(given) = Eigen::Map<const Eigen::VectorXd>(spec.values.data(), given);
  return rho;
}

void resolveNoiseCorrelation(ExperimentSpec& experiment) {
  for (NoiseCorrelationSpec& correlation : experiment.noise.correlation) {
    const std::vector<double> times = collectTimesOf(correlation.name.text, experiment.features);
    if (correlation.sample_time || times.size() < 2) {
      continue;
    }
    const double spacing = (times.back() - times.front()) / (static_cast<double>(times.size()) - 1.0);
    if (!findLags(times, spacing).empty()) {
      correlation.sample_time = std::round(spacing * 1e12) / 1e12;  // whole picoseconds, as sample times
    }
  }
}

}  // namespace twinmap
