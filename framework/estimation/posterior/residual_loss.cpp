#include "framework/estimation/posterior/residual_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Of an outlier, in noise standard deviations: a spike of 20 and one of 500 are both nothing unusual.
constexpr double kOutlierScale = 10.0;

/// Likelihoods of a residual, relative to that of noise at 0.
struct Likelihoods {
  double noise, outlier;
};

Likelihoods calcLikelihoods(double residual, double outlier_share) {
  const double ratio = residual / kOutlierScale;
  const double peak = std::sqrt(2.0 / std::acos(-1.0)) / kOutlierScale;  // Cauchy's over the normal one's
  return {(1.0 - outlier_share) * std::exp(-0.5 * residual * residual),
          outlier_share * peak / (1.0 + ratio * ratio)};
}

}  // namespace

ResidualLoss::ResidualLoss(std::vector<int> level_of, double outlier_share)
    : level_of_(std::move(level_of)), outlier_share_(outlier_share) {
  for (const int level : level_of_) {
    levels_ = std::max(levels_, level + 1);
  }
}

ResidualLoss::Levels ResidualLoss::sumLevels(const VectorXd& residual,
                                             const std::vector<Index>& features) const {
  Levels levels{VectorXd::Zero(levels_), VectorXd::Zero(levels_)};
  for (Index i = 0; i < residual.size(); ++i) {
    if (const int level = getLevel(features[static_cast<std::size_t>(i)]); level >= 0) {
      levels.squares[level] += residual[i] * residual[i];
      levels.counts[level] += 1.0;
    }
  }
  return levels;
}

double ResidualLoss::calc(const VectorXd& residual, const std::vector<Index>& features) const {
  if (isPlain()) {
    return residual.squaredNorm();
  }
  double loss = 0.0;
  const Levels levels = sumLevels(residual, features);
  for (int level = 0; level < levels_; ++level) {
    if (levels.counts[level] > 0.0) {
      const double mean = levels.squares[level] / levels.counts[level];
      loss += levels.counts[level] * std::log(std::max(mean, std::numeric_limits<double>::min()));
    }
  }
  for (Index i = 0; i < residual.size(); ++i) {
    if (getLevel(features[static_cast<std::size_t>(i)]) >= 0) {
      continue;
    }
    const double square = residual[i] * residual[i];
    if (outlier_share_ > 0.0) {
      const Likelihoods likelihoods = calcLikelihoods(residual[i], outlier_share_);
      loss -= 2.0 * std::log(likelihoods.noise + likelihoods.outlier);
    } else {
      loss += square;
    }
  }
  return std::isfinite(residual.squaredNorm()) ? loss : std::numeric_limits<double>::infinity();
}

VectorXd ResidualLoss::calcWeights(const VectorXd& residual, const std::vector<Index>& features) const {
  VectorXd weights = VectorXd::Ones(residual.size());
  const Levels levels = sumLevels(residual, features);
  for (Index i = 0; i < residual.size(); ++i) {
    if (const int level = getLevel(features[static_cast<std::size_t>(i)]); level >= 0) {
      weights[i] = levels.counts[level] / std::max(levels.squares[level], std::numeric_limits<double>::min());
    } else if (outlier_share_ > 0.0) {
      const Likelihoods likelihoods = calcLikelihoods(residual[i], outlier_share_);
      const double is_noise = likelihoods.noise / (likelihoods.noise + likelihoods.outlier);
      const double of_outlier = 2.0 / (kOutlierScale * kOutlierScale + residual[i] * residual[i]);
      weights[i] = is_noise + (1.0 - is_noise) * of_outlier;
    }
  }
  return weights;
}

}  // namespace twinmap
