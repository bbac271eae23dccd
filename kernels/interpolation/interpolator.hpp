#pragma once

#include <Eigen/Core>

namespace twinmap::gp {

/// Everything an interpolator consists of.
struct InterpolatorParts {
  Eigen::MatrixXd points;         ///< Z, p x n
  Eigen::VectorXd length_scales;  ///< p, in the units of the points
  Eigen::MatrixXd weights;        ///< n x r, K^-1 (S - mean)'
  Eigen::VectorXd mean;           ///< r
  /// r, mean squared error of each function at a point that is left out.
  Eigen::VectorXd left_out_variance;
};

/// r smooth functions of p variables, known without noise at n points, by the mean of a Gaussian process with
/// squared exponential covariance whose length scales all functions share: one row of covariances serves
/// values and derivatives of all. Immutable.
class Interpolator {
 public:
  /// The buffers of one thread, and what was found.
  struct Workspace {
    Eigen::VectorXd values;    ///< r
    Eigen::MatrixXd jacobian;  ///< r x p
    Eigen::ArrayXd covariance;
    Eigen::MatrixXd scaled;
  };

  /// Throws std::invalid_argument if the parts do not fit each other or a number is not finite.
  explicit Interpolator(InterpolatorParts parts);

  const InterpolatorParts& getParts() const { return parts_; }
  Eigen::Index getVariableCount() const { return parts_.points.rows(); }
  Eigen::Index getFunctionCount() const { return parts_.mean.size(); }

  /// Values and derivatives at `point` (p). No allocation once the workspace has been used.
  /// Cost: 2 n (r + 1) (p + 1) flops and n exponentials.
  void evaluate(const Eigen::Ref<const Eigen::VectorXd>& point, Workspace& workspace) const;

 private:
  InterpolatorParts parts_;
  Eigen::MatrixXd scaled_points_;  // Z / l, n x p
};

/// Fits an interpolator to `values` (r x n) at `points` (p x n, n > p + 1, each variable spread over about
/// [-1, 1]). The values are in units of the accuracy that is wanted: the length scales minimise
///   sum over functions of log(1 + mean squared error of the points left out),
/// by NLopt's BOBYQA from 1, on at most 300 points; all points are used thereafter.
/// Deterministic. Throws std::invalid_argument for sizes that do not fit or numbers that are not finite.
/// Cost: some 100 evaluations of 300^3 flops, then n^3.
Interpolator fitInterpolator(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values);

}  // namespace twinmap::gp
