#include "framework/data/noise/noise_estimate.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// a of order p - 1 to order p by the reflection coefficient k (Levinson's recursion).
std::vector<double> raiseOrder(const std::vector<double>& a, double k) {
  std::vector<double> raised = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    raised[i] -= k * a[a.size() - 1 - i];
  }
  raised.push_back(k);
  return raised;
}

VectorXd removeLine(const VectorXd& samples) {
  const Index n = samples.size();
  const VectorXd x = VectorXd::LinSpaced(n, -1.0, 1.0);
  const double slope = x.dot(samples) / x.squaredNorm();
  return (samples.array() - samples.mean()).matrix() - slope * x;
}

/// w_k = x_k - sum a_i x_{k-i}, from the first sample on that has all its predecessors.
VectorXd calcInnovations(const VectorXd& samples, const AutoregressiveModel& model) {
  const auto order = static_cast<Index>(model.coefficients.size());
  VectorXd innovations = samples.tail(samples.size() - order);
  for (Index i = 0; i < order; ++i) {
    innovations -= model.coefficients[i] * samples.segment(order - 1 - i, innovations.size());
  }
  return innovations;
}

/// Ljung and Box (1978): Q = n (n + 2) sum_k r_k^2 / (n - k) over h lags is chi-square with h - p degrees of
/// freedom.
double testWhiteness(const VectorXd& innovations, Index order) {
  constexpr Index kLags = 20;
  const Index n = innovations.size(), lags = std::min(order + kLags, n / 2);
  const VectorXd centred = innovations.array() - innovations.mean();
  double sum = 0.0;
  for (Index k = 1; k <= lags; ++k) {
    const double r = centred.head(n - k).dot(centred.tail(n - k)) / centred.squaredNorm();
    sum += r * r / static_cast<double>(n - k);
  }
  const boost::math::chi_squared distribution(static_cast<double>(lags - order));
  return boost::math::cdf(complement(distribution, static_cast<double>(n * (n + 2)) * sum));
}

/// The standard error of a standard deviation from n correlated normal samples, relative to it:
/// sqrt(sum over all lags of rho_k^2 / (2 n)).
double calcRelativeError(const AutoregressiveModel& model, Index n) {
  constexpr Index kLongestMemory = 1000;
  const VectorXd rho = calcAutocorrelation(model, std::min(n, kLongestMemory));
  return std::sqrt((2.0 * rho.squaredNorm() - 1.0) / (2.0 * static_cast<double>(n)));
}

}  // namespace

AutoregressiveModel fitAutoregression(const VectorXd& samples, int max_order) {
  const auto n = static_cast<double>(samples.size());
  VectorXd forward = samples.tail(samples.size() - 1), backward = samples.head(samples.size() - 1);
  double variance = samples.squaredNorm() / n;
  AutoregressiveModel best{{}, std::sqrt(variance)};
  double least = n * std::log(variance);
  std::vector<double> a;
  for (int order = 1; order <= max_order && variance > 0.0; ++order) {
    const double k = 2.0 * forward.dot(backward) / (forward.squaredNorm() + backward.squaredNorm());
    a = raiseOrder(a, k);
    variance *= 1.0 - k * k;
    const double bic = n * std::log(variance) + order * std::log(n);
    if (bic < least) {
      least = bic;
      best = {a, std::sqrt(variance)};
    }
    const VectorXd next = forward - k * backward;
    backward = (backward - k * forward).head(forward.size() - 1).eval();
    forward = next.tail(next.size() - 1);
  }
  return best;
}

VectorXd calcAutocorrelation(const AutoregressiveModel& model, Index count) {
  constexpr Index kTail = 4000;
  const auto order = static_cast<Index>(model.coefficients.size());
  VectorXd impulse = VectorXd::Zero(count + kTail);
  impulse[0] = 1.0;
  for (Index k = 1; k < impulse.size(); ++k) {
    for (Index i = 0; i < std::min(order, k); ++i) {
      impulse[k] += model.coefficients[i] * impulse[k - 1 - i];
    }
  }
  const Index shown = order == 0 ? 1 : count;
  VectorXd rho = VectorXd::Zero(count);
  for (Index lag = 0; lag < shown; ++lag) {
    rho[lag] = impulse.head(impulse.size() - lag).dot(impulse.tail(impulse.size() - lag));
  }
  return rho / rho[0];
}

NoiseEstimate estimateNoise(const VectorXd& samples) {
  constexpr Index kMin = 20, kSamplesPerOrder = 10, kMaxOrder = 20;
  if (samples.size() < kMin) {
    throw std::invalid_argument("has " + std::to_string(samples.size()) + " samples; must have at least 20");
  }
  const VectorXd noise = removeLine(samples);
  const Index n = samples.size();
  NoiseEstimate estimate;
  estimate.mean = samples.mean();
  estimate.stddev = std::sqrt(noise.squaredNorm() / static_cast<double>(n - 2));
  constexpr double kRounding = 1e-12;
  if (!(estimate.stddev > kRounding * samples.cwiseAbs().maxCoeff())) {
    throw std::invalid_argument("lies on a straight line: has no noise");
  }
  estimate.model = fitAutoregression(noise, static_cast<int>(std::min(kMaxOrder, n / kSamplesPerOrder)));
  estimate.stddev_error = estimate.stddev * calcRelativeError(estimate.model, n);
  estimate.whiteness = testWhiteness(calcInnovations(noise, estimate.model),
                                     static_cast<Index>(estimate.model.coefficients.size()));
  return estimate;
}

}  // namespace twinmap
