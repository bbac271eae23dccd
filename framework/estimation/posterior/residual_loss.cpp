#include "framework/estimation/posterior/residual_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

double calcMeanSquare(const VectorXd& residual) {
  return std::max(residual.squaredNorm() / static_cast<double>(residual.size()),
                  std::numeric_limits<double>::min());
}

}  // namespace

double calcLoss(LossKind kind, const VectorXd& residual) {
  const double squares = residual.squaredNorm();
  if (kind == LossKind::kPlain || !std::isfinite(squares)) {
    return squares;
  }
  if (kind == LossKind::kUnknownNoise) {
    return static_cast<double>(residual.size()) * std::log(calcMeanSquare(residual));
  }
  double loss = 0.0;
  for (const double one : residual) {
    const Likelihoods likelihoods = calcLikelihoods(one);
    loss -= 2.0 * std::log(likelihoods.noise + likelihoods.outlier);
  }
  return loss;
}

VectorXd calcLossWeights(LossKind kind, const VectorXd& residual) {
  if (kind == LossKind::kPlain) {
    return VectorXd::Ones(residual.size());
  }
  if (kind == LossKind::kUnknownNoise) {
    return VectorXd::Constant(residual.size(), 1.0 / calcMeanSquare(residual));
  }
  return residual.unaryExpr([](double one) {
    const Likelihoods likelihoods = calcLikelihoods(one);
    const double is_noise = likelihoods.noise / (likelihoods.noise + likelihoods.outlier);
    return is_noise + (1.0 - is_noise) * 2.0 / (kOutlierScale * kOutlierScale + one * one);
  });
}

}  // namespace twinmap
