#pragma once

#include <Eigen/Core>

#include "kernels/exact/exact.hpp"
#include "kernels/surrogate/shared_covariance.hpp"

namespace twinmap::gp {

/// Derivatives of r functions with respect to the first u variables, at the first m of n points: row v m + i
/// is that with respect to variable v at point i. m = 0: none are known.
struct SlopeData {
  Eigen::MatrixXd values;      ///< u m x r
  Eigen::Index variables = 0;  ///< u

  Eigen::Index countPoints() const { return variables == 0 ? 0 : values.rows() / variables; }
};

/// Covariances at one point of n values and of slopes times length scales at the first m of their points, as
/// in a joint covariance: D = (x - z) / l,
///   cov(f(x), f(z)) = k,   cov(f(x), l_v df/dz_v) = g D_v,
///   l_w d/dx_w of these:  -g D_w,   g [v = w] - h D_v D_w.
struct PointCovariance {
  Eigen::ArrayXXd differences;        ///< D, n x p
  Eigen::ArrayXd squares, values;     ///< s and k, n
  Eigen::ArrayXd slopes, curvatures;  ///< g and h, n
  Eigen::ArrayXd projected, buffer;   ///< room for what is made of them

  exact::smooth_point getView();
};

/// What the points z (n x p, scaled by 1 / l) are, with slopes at the first m of them with respect to the
/// first u variables. Valid as long as `scaled_points`.
exact::smooth_process describeProcess(SmoothCovariance covariance, double nugget,
                                      const Eigen::MatrixXd& scaled_points, Eigen::Index slope_points,
                                      Eigen::Index slope_variables);

/// Fills it for a point x, scaled likewise (p).
void calcPointCovariance(const exact::smooth_process& process, const Eigen::VectorXd& scaled_point,
                         PointCovariance& found);

/// What the weights of n values and u m slopes are multiplied by for a value at the point: n + u m.
void fillValueRow(const PointCovariance& covariance, Eigen::Index slope_points, Eigen::Index variables,
                  Eigen::Ref<Eigen::VectorXd> row);

/// The same for the value's derivative with respect to variable w, times l_w.
void fillSlopeRow(const PointCovariance& covariance, Eigen::Index slope_points, Eigen::Index variables,
                  Eigen::Index w, Eigen::Ref<Eigen::VectorXd> row);

/// Joint covariance (lower triangle, n + u m) of values and of slopes times length scales, the nuggets on the
/// diagonal. Cost: (n + u m)^2 stores.
Eigen::MatrixXd calcJointCovariance(const SharedStructure& structure,
                                    const SharedHyperparameters& hyperparameters,
                                    const Eigen::MatrixXd& points, Eigen::Index slope_points,
                                    Eigen::Index variables);

/// The trend's terms at the points, and their slopes times length scales: n + u m x q.
Eigen::MatrixXd calcJointTerms(Trend trend, const Eigen::VectorXd& length_scales,
                               const Eigen::MatrixXd& points, Eigen::Index slope_points,
                               Eigen::Index variables);

}  // namespace twinmap::gp
