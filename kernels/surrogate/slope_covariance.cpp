#include "kernels/surrogate/slope_covariance.hpp"

#include "kernels/linalg/packed_lower.hpp"

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

static_assert(static_cast<int>(SmoothCovariance::kSquaredExponential) == exact::SMOOTH_EXPONENTIAL);
static_assert(static_cast<int>(SmoothCovariance::kMatern52) == exact::SMOOTH_MATERN_52);

exact::smooth_point PointCovariance::getView() {
  return {differences.data(), squares.data(),   values.data(), slopes.data(),
          curvatures.data(),  projected.data(), buffer.data()};
}

exact::smooth_process describeProcess(SmoothCovariance covariance, double nugget,
                                      const MatrixXd& scaled_points, Index slope_points,
                                      Index slope_variables) {
  return {static_cast<int>(covariance),
          static_cast<int>(scaled_points.rows()),
          static_cast<int>(scaled_points.cols()),
          static_cast<int>(slope_points),
          static_cast<int>(slope_variables),
          nugget,
          scaled_points.data()};
}

void calcPointCovariance(const exact::smooth_process& process, const VectorXd& scaled_point,
                         PointCovariance& found) {
  const Index n = process.points;
  found.differences.resize(n, process.variables);
  for (ArrayXd* each : {&found.squares, &found.values, &found.slopes, &found.curvatures}) {
    each->resize(n);
  }
  found.projected.resize(process.slope_points);
  found.buffer.resize(linalg::PackedLower::roundUp(n));
  exact::calcPointCovariance(process, scaled_point.data(), found.getView());
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
  const exact::smooth_process process =
      describeProcess(structure.covariance, hyperparameters.nugget, scaled, slope_points, variables);
  PointCovariance at;
  for (Index j = 0; j < n; ++j) {
    calcPointCovariance(process, scaled.row(j).transpose(), at);
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
