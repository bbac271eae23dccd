#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/surrogate/shared_covariance.hpp"

namespace twinmap::gp {

/// The variance (of a process of unit variance, nugget included) of a value given those at the nearest 20
/// points alone, without trend: n^2 numbers are too many to keep, and to read for each prediction. Only its
/// ratio between points is used; what it is multiplied by comes from points left out. Of processes that had
/// learnt from slopes, in windows of nine mechanisms, it foretold the errors as well as their own variance
/// did.
class LocalVariance {
 public:
  /// The buffers of one thread.
  struct Workspace {
    std::vector<Eigen::Index> order;
    Eigen::ArrayXd values, slopes;
  };

  LocalVariance() = default;
  LocalVariance(SmoothCovariance covariance, double nugget) : covariance_(covariance), nugget_(nugget) {}

  /// At a point of which the squares s of scaled distances and the covariances k to n points (n x p, scaled)
  /// are given. `but`: the index of a point that is left out, or -1. Cost: 200 exponentials, 20^3 / 3 flops.
  double calc(const Eigen::MatrixXd& scaled_points, const Eigen::ArrayXd& squares,
              const Eigen::ArrayXd& covariances, Eigen::Index but, Workspace& workspace) const;

 private:
  SmoothCovariance covariance_ = SmoothCovariance::kSquaredExponential;
  double nugget_ = 0.0;
};

}  // namespace twinmap::gp
