#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void calcPointCovariance(SmoothCovariance covariance, const MatrixXd& scaled_points,
                         const Eigen::Ref<const VectorXd>& scaled_point, bool curvatures,
                         PointCovariance& found) {
  const Index n = scaled_points.rows();
  found.differences.resize(n, scaled_points.cols());
  found.squares.setZero(n);
  for (Index v = 0; v < scaled_points.cols(); ++v) {
    found.differences.col(v) = scaled_point(v) - scaled_points.col(v).array();
    found.squares += found.differences.col(v).square();
  }
  found.values = found.squares;
  found.slopes.resize(n);
  if (curvatures) {
    found.curvatures.resize(n);
    calcSmoothCovariance(covariance, found.values, found.slopes, found.curvatures);
  } else {
    calcSmoothCovariance(covariance, found.values, found.slopes);
  }
}

void fillValueRow(const PointCovariance& covariance, Index slope_points, Index variables,
                  Eigen::Ref<VectorXd> row) {
  const Index n = covariance.values.size();
  row.head(n) = covariance.values.matrix();
  for (Index v = 0; v < variables && slope_points > 0; ++v) {
    row.segment(n + v * slope_points, slope_points).array() =
        covariance.slopes.head(slope_points) * covariance.differences.col(v).head(slope_points);
  }
}

void fillSlopeRow(const PointCovariance& covariance, Index slope_points, Index variables, Index w,
                  Eigen::Ref<VectorXd> row) {
  const Index n = covariance.values.size();
  row.head(n).array() = -covariance.slopes * covariance.differences.col(w);
  for (Index v = 0; v < variables && slope_points > 0; ++v) {
    auto part = row.segment(n + v * slope_points, slope_points).array();
    part = -covariance.curvatures.head(slope_points) * covariance.differences.col(v).head(slope_points) *
           covariance.differences.col(w).head(slope_points);
    if (v == w) {
      part += covariance.slopes.head(slope_points);
    }
  }
}

MatrixXd calcJointCovariance(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                             const MatrixXd& points, Index slope_points, Index variables) {
  const Index n = points.cols(), size = n + variables * slope_points;
  const MatrixXd scaled = points.transpose() * hyperparameters.length_scales.cwiseInverse().asDiagonal();
  MatrixXd joint(size, size);
  PointCovariance at;
  for (Index j = 0; j < n; ++j) {
    calcPointCovariance(structure.covariance, scaled, scaled.row(j).transpose(), slope_points > 0, at);
    fillValueRow(at, slope_points, variables, joint.col(j));
    joint(j, j) += hyperparameters.nugget;
    for (Index w = 0; w < variables && j < slope_points; ++w) {
      const Index column = n + w * slope_points + j;
      fillSlopeRow(at, slope_points, variables, w, joint.col(column));
      joint(column, column) += hyperparameters.slope_nugget;
    }
  }
  return joint;
}

MatrixXd calcJointTerms(Trend trend, const VectorXd& length_scales, const MatrixXd& points,
                        Index slope_points, Index variables) {
  const Index n = points.cols();
  MatrixXd terms(n + variables * slope_points, countTerms(trend, points.rows()));
  terms.topRows(n) = calcTerms(trend, points).transpose();
  MatrixXd derivatives;
  for (Index i = 0; i < slope_points; ++i) {
    calcTermDerivatives(trend, points.col(i), derivatives);
    for (Index v = 0; v < variables; ++v) {
      terms.row(n + v * slope_points + i) = length_scales(v) * derivatives.col(v).transpose();
    }
  }
  return terms;
}

}  // namespace twinmap::gp
