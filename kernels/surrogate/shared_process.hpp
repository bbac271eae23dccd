#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/linalg/packed_lower.hpp"
#include "kernels/surrogate/joint_fit.hpp"
#include "kernels/surrogate/left_out_density.hpp"
#include "kernels/surrogate/slope_covariance.hpp"

namespace twinmap::gp {

/// The numbers that a SharedProcess predicts from: n points, p variables, q terms of the trend, r functions.
struct SharedProcessParts {
  SharedStructure structure;
  SharedHyperparameters hyperparameters;
  Eigen::MatrixXd scaled_points;     ///< n x p, over the length scales
  Eigen::Index slope_points = 0;     ///< m: the first points, whose slopes are known ...
  Eigen::Index slope_variables = 0;  ///< ... with respect to the first u variables
  Eigen::MatrixXd weights;           ///< of values, then of slopes, n + u m x r
  Eigen::MatrixXd coefficients;      ///< of the trend, q x r
  Eigen::VectorXd factor_tiles;      ///< of K's lower factor (linalg::PackedLower); this and the next two are
                                     ///< empty where slopes are known
  Eigen::MatrixXd solved_terms;      ///< L^-1 H', n x q
  Eigen::MatrixXd term_factor;       ///< lower factor of H K^-1 H', q x q
  Eigen::VectorXd amplitude;         ///< LeftOut::amplitude, r
  Eigen::VectorXd left_out_ratio;    ///< n
};

/// r smooth functions of p variables, known without noise at n points, with their slopes at the first m: a
/// Gaussian process each, with one covariance function and trend for all. Each function's variance is the one
/// with which the points that are left out agree (LeftOut::amplitude), times a local factor that all share:
/// the ratio of the squared errors of the nearest points, left out, to their variance. The variance that both
/// multiply is the process's own. Where slopes are known, that would take n^2 numbers, too many to keep and
/// to read for each prediction: there it is that of a value given those at the nearest 20 points alone, which
/// predicted the errors, in windows of nine mechanisms, as well. What is predicted has the same bits wherever
/// it is (kernels/exact). Immutable.
class SharedProcess {
 public:
  /// The buffers of one thread.
  struct Workspace {
    Eigen::MatrixXd term_derivatives;
    PointCovariance at;
    Eigen::VectorXd scaled_point, terms, rising, derivatives, rest;
    Eigen::MatrixXd solved, many_terms;  // of evaluateMany()
    Eigen::VectorXd factors;
  };

  /// points: p x n; values: n x r. Throws std::invalid_argument for sizes that do not fit,
  /// std::runtime_error if the covariance is not positive definite. Cost: 2 n^3 flops.
  SharedProcess(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, SharedStructure structure,
                SharedHyperparameters hyperparameters);

  /// A process that predicts bit for bit as the one that the parts are of; it has no LeftOut but the
  /// amplitude. Throws std::invalid_argument for sizes that do not fit.
  explicit SharedProcess(SharedProcessParts parts);
  SharedProcessParts getParts() const;
  /// Learns from slopes as well. Cost: 2 / 3 (n + u m)^3 flops.
  SharedProcess(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, const SlopeData& slopes,
                SharedStructure structure, SharedHyperparameters hyperparameters);
  /// The same from a fit of them (fitJointly, JointPrecision).
  SharedProcess(const Eigen::MatrixXd& points, const SlopeData& slopes, JointFit fit,
                SharedStructure structure, SharedHyperparameters hyperparameters);

  Eigen::Index getFunctionCount() const { return weights_.cols(); }
  const SharedStructure& getStructure() const { return structure_; }
  const SharedHyperparameters& getHyperparameters() const { return hyperparameters_; }
  const LeftOut& getLeftOut() const { return left_out_; }
  /// Of each point, left out: the mean over the functions of its squared error over its variance; n.
  const Eigen::ArrayXd& getLeftOutRatio() const { return left_out_ratio_; }

  /// Keeps some of the functions.
  void select(const std::vector<Eigen::Index>& functions);

  /// Values of the first functions (at most r, as many as `values`) at a point (p). Cost: 2 (n + u m) (p + r)
  /// flops and n exponentials.
  void evaluate(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::VectorXd> values,
                Workspace& workspace) const;

  /// Values, and their derivatives (rows) with respect to the first variables (columns). Cost: twice that of
  /// evaluate(); the weights, which fit no fast cache, are read once.
  void linearize(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::VectorXd> values,
                 Eigen::Ref<Eigen::MatrixXd> jacobian, Workspace& workspace) const;

  /// Standard deviations (r) of the values at the point evaluated or linearised at last, nugget and local
  /// factor included. Cost: n^2 flops; where slopes are known that of exact::calcLocalVariance().
  void calcStddev(Eigen::Ref<Eigen::VectorXd> stddev, Workspace& workspace) const;

  /// Values and standard deviations (r x b) at many points (p x b): those of evaluate() and calcStddev() up
  /// to the rounding of the variances. Cost: the same flops; the factor that variances take is read once for
  /// some dozens of points, so that its n^2 / 2 numbers do not come from memory for each.
  void evaluateMany(const Eigen::Ref<const Eigen::MatrixXd>& points, Eigen::Ref<Eigen::MatrixXd> values,
                    Eigen::Ref<Eigen::MatrixXd> stddev, Workspace& workspace) const;

 private:
  bool fitTogether() const;
  void requireSizes(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values) const;
  void updateLeftOutRatio();
  void leaveOutLocally(const Eigen::MatrixXd& points, const Eigen::MatrixXd& residual);
  void prepare(const Eigen::Ref<const Eigen::VectorXd>& point, Workspace& workspace) const;
  exact::smooth_process describe() const;
  double calcValue(Eigen::Index function, Workspace& workspace) const;
  void derive(Eigen::Index function, Eigen::Ref<Eigen::MatrixXd> jacobian, Workspace& workspace) const;
  double calcOwnVariance(Workspace& workspace) const;
  void evaluateBlock(const Eigen::Ref<const Eigen::MatrixXd>& points, Eigen::Ref<Eigen::MatrixXd> values,
                     Eigen::Ref<Eigen::MatrixXd> stddev, Workspace& workspace) const;
  exact::own_variance describeOwnVariance() const;
  void scaleStddev(double variance, Eigen::Ref<Eigen::VectorXd> stddev) const;

  SharedStructure structure_;
  SharedHyperparameters hyperparameters_;
  Eigen::MatrixXd scaled_points_;                        // n x p, over the length scales
  Eigen::Index slope_points_ = 0, slope_variables_ = 0;  // m, u
  Eigen::MatrixXd weights_;                              // n + u m x r
  Eigen::MatrixXd coefficients_;                         // of the trend, q x r
  linalg::PackedLower factor_;    // of K; this and the next two only where no slopes are known
  Eigen::MatrixXd solved_terms_;  // L^-1 H', n x q
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      term_factor_;  // lower factor of H K^-1 H', q x q
  LeftOut left_out_;
  Eigen::ArrayXd left_out_ratio_;  // n
};

}  // namespace twinmap::gp
