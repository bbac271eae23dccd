#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// How the residuals of one measurement count: as normal noise of the stated size (plain), of a size that is
/// not known, or with outliers among them. Immutable.
class ResidualLoss {
 public:
  /// Plain.
  ResidualLoss() = default;

  /// level_of: for each feature the number of the unknown noise level (0, 1, ...) that its output has, or -1
  /// where the stated size holds; empty for that everywhere. Unknown levels are integrated out under a prior
  /// that is uniform in their logarithm (Jeffreys), so that n residuals r of one count as n log r'r.
  /// outlier_share: of samples that are not noise but anything (spikes); 0 for none. An outlier has a Cauchy
  /// distribution of ten noise standard deviations.
  ResidualLoss(std::vector<int> level_of, double outlier_share);

  bool isPlain() const { return level_of_.empty() && outlier_share_ == 0.0; }

  /// -2 log likelihood, but for a summand, of whitened residuals (k); features: which of all each is of.
  double calc(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& features) const;

  /// The weights (k) of a sum of squares with the same slope there: 1 / size^2 of an unknown level, about 0 of
  /// an outlier.
  Eigen::VectorXd calcWeights(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& features) const;

 private:
  /// Sum of squares and number of residuals of each unknown level.
  struct Levels {
    Eigen::VectorXd squares, counts;
  };

  int getLevel(Eigen::Index feature) const {
    return level_of_.empty() ? -1 : level_of_[static_cast<std::size_t>(feature)];
  }
  Levels sumLevels(const Eigen::VectorXd& residual, const std::vector<Eigen::Index>& features) const;

  std::vector<int> level_of_;
  int levels_ = 0;
  double outlier_share_ = 0.0;
};

}  // namespace twinmap
