#include "framework/estimation/posterior/noise/outlier_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/levels.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kOutlierShare = 0.01;  // of samples, before they are seen
constexpr double kOutlierScale = 10.0;  // in noise standard deviations

/// Likelihoods of a residual, relative to that of noise at 0.
struct Likelihoods {
  double noise, outlier;
};

Likelihoods calcLikelihoods(double residual) {
  const double ratio = residual / kOutlierScale;
  const double peak = std::sqrt(2.0 / std::acos(-1.0)) / kOutlierScale;  // Cauchy's over the normal one's
  return {(1.0 - kOutlierShare) * std::exp(-0.5 * residual * residual),
          kOutlierShare * peak / (1.0 + ratio * ratio)};
}

double calcMedianSpread(const VectorXd& residual) {
  const double size = calcRobustSize(residual);
  return size > 0.0 ? size : std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
}

}  // namespace

double calcRobustSize(const VectorXd& values) {
  return calcMedian(VectorXd(values.cwiseAbs())) / kNormal50;
}

double calcOutlierLoss(double residual) {
  const Likelihoods likelihoods = calcLikelihoods(residual);
  return -2.0 * std::log(likelihoods.noise + likelihoods.outlier);
}

double calcOutlierWeight(double residual) {
  const Likelihoods likelihoods = calcLikelihoods(residual);
  const double is_noise = likelihoods.noise / (likelihoods.noise + likelihoods.outlier);
  return is_noise + (1.0 - is_noise) * 2.0 / (kOutlierScale * kOutlierScale + residual * residual);
}

OutlierSize findOutlierSize(const VectorXd& residual) {
  constexpr int kMaxSteps = 100;
  const auto n = static_cast<double>(residual.size());
  OutlierSize found;
  found.size = std::max(calcMedianSpread(residual), std::numeric_limits<double>::min());
  for (int i = 0; i < kMaxSteps; ++i) {
    // where the slope vanishes, s^2 is the mean of the weighted squares
    const VectorXd weights = (residual / found.size).unaryExpr(&calcOutlierWeight);
    const double next =
        std::max(std::sqrt(weights.dot(residual.cwiseAbs2()) / n), std::numeric_limits<double>::min());
    const bool converged = std::abs(next - found.size) <= kSameNumber * found.size;
    found.size = next;
    if (converged) {
      break;
    }
  }
  found.loss = 2.0 * n * std::log(found.size);
  for (const double one : residual) {
    found.loss += calcOutlierLoss(one / found.size);
  }
  return found;
}

}  // namespace twinmap
