#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The distribution of one number as weighted values of it.
class ValueDistribution {
 public:
  /// `values` and positive `weights` (n each, of any sum); values that are not finite are left out. Without
  /// any finite value everything is NaN.
  ValueDistribution(const Eigen::VectorXd& values, const Eigen::VectorXd& weights);

  bool isDefined() const { return values_.size() > 0; }
  double getMean() const { return mean_; }
  double getStddev() const { return stddev_; }

  /// The value below which this probability, in (0, 1), lies: linear between the values, each of which stands
  /// in the middle of its weight; the outermost values beyond them.
  double calcQuantile(double probability) const;

  /// The inverse of calcQuantile(): 0 or 1 beyond the outermost values.
  double calcProbability(double value) const;

 private:
  Eigen::VectorXd values_, probabilities_;  // ascending
  double mean_, stddev_;
};

}  // namespace twinmap
