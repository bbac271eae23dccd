#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The autoregression a_1 .. a_p whose partial autocorrelations are these, each within -1 and 1: stationary,
/// and every stationary one is one of them (Levinson and Durbin's recursion; Barndorff-Nielsen and Schou
/// 1973). Cost: p^2.
Eigen::VectorXd makeAutoregression(const Eigen::VectorXd& partial_autocorrelations);

/// Makes samples of a stationary autoregressive process of unit variance,
///   e_k = a_1 e_{k-1} + ... + a_p e_{k-p} + w_k,
/// independent and of unit variance, where any of them may be missing: each sample less its prediction from
/// those before, over the standard deviation of that, by a Kalman filter whose gains do not depend on the
/// samples. The rows W of this linear map fulfil W R W' = 1 for the process's correlation R.
class AutoregressiveWhitener {
 public:
  /// lags: of the n samples, in sample times, strictly increasing (findLags). The autoregression must be
  /// stationary, p at least 1. Cost: p^2 a sample time.
  AutoregressiveWhitener(const Eigen::VectorXd& autoregression, const std::vector<long>& lags);

  /// c series, as columns that are one sample each (c x n), in place. Cost: p c a sample time.
  void apply(Eigen::MatrixXd& series) const;

  /// log |R|.
  double getLogDeterminant() const { return log_determinant_; }

 private:
  const Eigen::VectorXd a_;
  const std::vector<long> lags_;
  Eigen::MatrixXd gains_;           // p x n
  Eigen::VectorXd inverse_stddev_;  // n, of the predictions' errors
  double log_determinant_ = 0.0;
};

}  // namespace twinmap
