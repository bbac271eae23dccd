#include "kernels/tracking/rate_bank.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap::tracking {

using Eigen::VectorXd;

double getRateRatio(int g) {
  constexpr int kLowest = -10;  // octave
  return std::ldexp(1.0, kLowest + g);
}

VectorXd makeLogRatePrior() {
  return VectorXd::NullaryExpr(kRates, [](Eigen::Index g) {
    const double ratio = getRateRatio(static_cast<int>(g));
    return 0.5 * (std::log(ratio) - ratio);
  });
}

namespace {

constexpr int kParts = 4;  // of an octave, within which the parabola is smooth

/// log_weights at an octave.
double interpolate(const VectorXd& log_weights, double octave) {
  const int middle = std::clamp(static_cast<int>(std::lround(octave)), 1, kRates - 2);
  const double x = octave - middle;
  const double before = log_weights[middle - 1], here = log_weights[middle], after = log_weights[middle + 1];
  return here + 0.5 * x * (after - before) + 0.5 * x * x * (after - 2.0 * here + before);
}

double toRatio(double octave) {
  return getRateRatio(0) * std::exp2(octave);
}

}  // namespace

RatePosterior calcRatePosterior(const RateFilters& filters) {
  constexpr Eigen::Index kCount = (kRates - 1) * kParts + 1;
  RatePosterior posterior{VectorXd::LinSpaced(kCount, 0.0, kRates - 1.0), VectorXd(kCount)};
  for (Eigen::Index i = 0; i < kCount; ++i) {
    posterior.weights[i] = interpolate(filters.log_weights, posterior.octaves[i]);
  }
  const double largest = posterior.weights.maxCoeff();
  posterior.weights = posterior.weights.unaryExpr([&](double log) { return std::exp(log - largest); });
  posterior.weights /= posterior.weights.sum();
  return posterior;
}

VectorXd RatePosterior::calcFilterWeights() const {
  VectorXd shared = VectorXd::Zero(kRates);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const Eigen::Index below = std::min<Eigen::Index>(i / kParts, kRates - 2);
    const double above = octaves[i] - static_cast<double>(below);
    shared[below] += (1.0 - above) * weights[i];
    shared[below + 1] += above * weights[i];
  }
  return shared;
}

double RatePosterior::calcMeanSquare() const {
  return weights.dot(octaves.unaryExpr([](double octave) { return std::pow(toRatio(octave), 2); }));
}

double RatePosterior::calcSquareStddev() const {
  const double mean = calcMeanSquare();
  const double square =
      weights.dot(octaves.unaryExpr([](double octave) { return std::pow(toRatio(octave), 4); }));
  return std::sqrt(std::max(0.0, square - mean * mean));
}

namespace {

double findQuantile(const RatePosterior& posterior, double probability) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < posterior.weights.size(); ++i) {
    const double weight = posterior.weights[i];
    if (sum + weight >= probability) {
      const double part = (probability - sum) / weight - 0.5;
      return toRatio(posterior.octaves[i] + part / kParts);
    }
    sum += weight;
  }
  return toRatio(kRates - 1);
}

}  // namespace

RateEstimate estimateRate(const RatePosterior& posterior) {
  const double mean = posterior.weights.dot(posterior.octaves);
  const double variance = posterior.weights.dot((posterior.octaves.array() - mean).square().matrix());
  return {findQuantile(posterior, 0.5), findQuantile(posterior, 0.025), findQuantile(posterior, 0.975),
          std::log(2.0) * std::sqrt(variance)};
}

Moments calcMoments(const RateFilters& filters, const RatePosterior& posterior) {
  const VectorXd weights = posterior.calcFilterWeights();
  Moments moments;
  for (int g = 0; g < kRates; ++g) {
    moments.mean += weights[g] * filters.beliefs[static_cast<std::size_t>(g)].mean[filters.parameter];
  }
  for (int g = 0; g < kRates; ++g) {
    const Belief& belief = filters.beliefs[static_cast<std::size_t>(g)];
    const double off = belief.mean[filters.parameter] - moments.mean;
    moments.variance += weights[g] * (belief.covariance(filters.parameter, filters.parameter) + off * off);
  }
  return moments;
}

}  // namespace twinmap::tracking
