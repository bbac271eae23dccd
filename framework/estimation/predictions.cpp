#include "framework/estimation/predictions.hpp"

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

void shrinkToBounds(const VectorXd& center, const VectorXd& half_width, Eigen::Ref<VectorXd> mean,
                    Eigen::Ref<VectorXd> stddev) {
  for (Index p = 0; p < center.size(); ++p) {
    if (stddev[p] > half_width[p]) {
      mean[p] = center[p] + half_width[p] / stddev[p] * (mean[p] - center[p]);
      stddev[p] = half_width[p];
    }
  }
}

void shrinkToBounds(const VectorXd& center, const VectorXd& half_width, Predictions& predictions) {
  for (std::size_t i = 0; i < predictions.mixtures.size(); ++i) {
    shrinkToBounds(center, half_width, predictions.stddev.col(static_cast<Index>(i)),
                   predictions.mixtures[i]);
  }
  for (Index i = 0; i < predictions.mean.cols(); ++i) {
    shrinkToBounds(center, half_width, predictions.mean.col(i), predictions.stddev.col(i));
  }
}

VectorXd calcDepths(const Predictions& predictions, const MatrixXd& truth, Index parameter) {
  if (predictions.mixtures.empty()) {
    return (predictions.mean - truth)
        .row(parameter)
        .cwiseQuotient(predictions.stddev.row(parameter))
        .cwiseAbs();
  }
  VectorXd depths(truth.cols());
  for (Index i = 0; i < depths.size(); ++i) {
    const Mixture& mixture = predictions.mixtures[static_cast<std::size_t>(i)];
    depths[i] = calcDepth(takeMarginal(mixture, parameter), truth(parameter, i));
  }
  return depths;
}

IntervalReach calcIntervalReach(const Predictions& predictions, const MatrixXd& truth, int draws) {
  constexpr double kMin = 400.0;
  const double samples = static_cast<double>(truth.cols()) / draws;
  if (samples < kMin) {
    return {};
  }
  IntervalReach reach{MatrixXd(truth.rows(), 1), MatrixXd(truth.rows(), 1)};
  for (Index p = 0; p < truth.rows(); ++p) {
    reach.set(p, 0, calcReach(calcDepths(predictions, truth, p), samples));
  }
  return (reach.of95.array() == kNormal95).all() ? IntervalReach{} : reach;
}

MatrixXd calcCorrelation(const MatrixXd& covariance) {
  const VectorXd inverse_stddev = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse_stddev.asDiagonal() * covariance * inverse_stddev.asDiagonal();
}

}  // namespace twinmap
