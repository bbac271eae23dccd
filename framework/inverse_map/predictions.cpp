#include "framework/inverse_map/predictions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void convert(const VectorXd& center, const VectorXd& unit, const VectorXd& stddev_scale,
             Predictions& predictions) {
  predictions.mean = (unit.asDiagonal() * predictions.mean).colwise() + center;
  predictions.stddev = stddev_scale.cwiseProduct(unit).asDiagonal() * predictions.stddev;
  for (std::size_t i = 0; i < predictions.mixtures.size(); ++i) {
    convert(center, unit, stddev_scale, predictions.mixtures[i]);
    const MatrixXd covariance = calcCovariance(predictions.mixtures[i]);
    predictions.stddev.col(static_cast<Index>(i)) = covariance.diagonal().cwiseSqrt();
    predictions.correlations[i] = calcCorrelation(covariance);
  }
}

MatrixXd calcCorrelation(const MatrixXd& covariance) {
  const VectorXd inverse_stddev = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse_stddev.asDiagonal() * covariance * inverse_stddev.asDiagonal();
}

}  // namespace twinmap
