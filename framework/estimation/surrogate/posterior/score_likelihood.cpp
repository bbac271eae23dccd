#include "framework/estimation/surrogate/posterior/score_likelihood.hpp"

#include <limits>

#include "framework/estimation/box_points.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ScoreLikelihood::ScoreLikelihood(const ForwardSurrogate& surrogate)
    : surrogate_(surrogate),
      workspaces_(surrogate.windows.size()),
      widening_(surrogate.windows.size(), 1.0),
      residual_(surrogate.getScoreCount()),
      scratch_(surrogate.getScoreCount()) {}

void ScoreLikelihood::setMeasurement(const Eigen::Ref<const VectorXd>& scores,
                                     const Eigen::Ref<const VectorXd>& known, std::vector<double> widening) {
  scores_ = scores;
  known_ = known;
  widening_ = std::move(widening);
}

VectorXd ScoreLikelihood::calcLogs(const MatrixXd& unknown) {
  return calcInBox(unknown, [this](const MatrixXd& inside) {
    points_.resize(inside.rows() + known_.size(), inside.cols());
    points_ << inside, known_.replicate(1, points_.cols());
    surrogate_.evaluate(points_, widening_, workspaces_, values_, stddev_);
    return VectorXd(VectorXd::NullaryExpr(inside.cols(), [this](Index k) { return calcLog(k); }));
  });
}

/// Of one of the points evaluated.
double ScoreLikelihood::calcLog(Index point) {
  const auto stddev = stddev_.col(point).asDiagonal();
  covariance_ = stddev * surrogate_.error_correlation * stddev;
  covariance_.diagonal().array() += 1.0;
  if (!linalg::factorizeCholesky(linalg::viewOf(covariance_), scratch_)) {
    return -std::numeric_limits<double>::infinity();  // not even finite
  }
  residual_ = scores_ - values_.col(point);
  linalg::solveLower(linalg::viewOf(covariance_), residual_.data());
  return -0.5 * residual_.squaredNorm() - covariance_.diagonal().array().log().sum();
}

}  // namespace twinmap
