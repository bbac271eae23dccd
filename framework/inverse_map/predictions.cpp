#include "framework/inverse_map/predictions.hpp"

namespace twinmap {

Eigen::MatrixXd calcCorrelation(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd inverse_stddev = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse_stddev.asDiagonal() * covariance * inverse_stddev.asDiagonal();
}

}  // namespace twinmap
