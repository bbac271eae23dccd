#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/linalg/packed_lower.hpp"
#include "kernels/surrogate/left_out_density.hpp"

namespace twinmap::gp {

/// The numbers that a SharedProcess predicts from: n points, p variables, q terms of the trend, r functions.
struct SharedProcessParts {
  SharedStructure structure;
  SharedHyperparameters hyperparameters;
  Eigen::MatrixXd scaled_points;  ///< n x p, over the length scales
  Eigen::MatrixXd weights;        ///< K^-1 (values - trend), n x r
  Eigen::MatrixXd coefficients;   ///< of the trend, q x r
  Eigen::VectorXd factor_tiles;   ///< of K's lower factor (linalg::PackedLower)
  Eigen::MatrixXd solved_terms;   ///< L^-1 H', n x q
  Eigen::MatrixXd term_factor;    ///< lower factor of H K^-1 H', q x q
  Eigen::VectorXd amplitude;      ///< LeftOut::amplitude, r
  Eigen::VectorXd left_out_ratio; ///< n
};

/// r smooth functions of p variables, known without noise at n points: a Gaussian process each, with one
/// covariance function and trend for all. Each function's variance is the one with which the points that are
/// left out agree (LeftOut::amplitude), times a local factor that all share: the ratio of the squared errors
/// of the nearest points, left out, to their variance. Immutable.
class SharedProcess {
 public:
  /// The buffers of one thread.
  struct Workspace {
    Eigen::MatrixXd scaled, term_derivatives;
    Eigen::ArrayXd squares, covariance, slopes, nearest;
    Eigen::VectorXd terms, solved;
  };

  /// points: p x n; values: n x r. Throws std::invalid_argument for sizes that do not fit,
  /// std::runtime_error if the covariance is not positive definite. Cost: 2 n^3 flops.
  SharedProcess(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, SharedStructure structure,
                SharedHyperparameters hyperparameters);

  /// A process that predicts bit for bit as the one that the parts are of; it has no LeftOut but the
  /// amplitude. Throws std::invalid_argument for sizes that do not fit.
  explicit SharedProcess(SharedProcessParts parts);
  SharedProcessParts getParts() const;

  Eigen::Index getFunctionCount() const { return weights_.cols(); }
  const SharedStructure& getStructure() const { return structure_; }
  const SharedHyperparameters& getHyperparameters() const { return hyperparameters_; }
  const LeftOut& getLeftOut() const { return left_out_; }
  /// Of each point, left out: the mean over the functions of its squared error over its variance; n.
  const Eigen::ArrayXd& getLeftOutRatio() const { return left_out_ratio_; }

  /// Keeps some of the functions.
  void select(const std::vector<Eigen::Index>& functions);

  /// Values (r) at a point (p). Cost: 2 n (p + r) flops and n exponentials.
  void evaluate(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::VectorXd> values,
                Workspace& workspace) const;

  /// Derivatives (r x u) with respect to the first u variables, of the point evaluated last. Cost: 2 n u r.
  void derive(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::MatrixXd> jacobian,
              Workspace& workspace) const;

  /// Standard deviations (r) of the values at the point evaluated last, nugget and local factor included.
  /// Cost: n^2 flops.
  void calcStddev(Eigen::Ref<Eigen::VectorXd> stddev, Workspace& workspace) const;

 private:
  void updateLeftOutRatio();
  double calcLocalFactor(Workspace& workspace) const;

  SharedStructure structure_;
  SharedHyperparameters hyperparameters_;
  Eigen::MatrixXd scaled_points_;  // n x p, over the length scales
  Eigen::MatrixXd weights_;        // n x r
  Eigen::MatrixXd coefficients_;   // of the trend, q x r
  linalg::PackedLower factor_;     // of K
  Eigen::MatrixXd solved_terms_;   // L^-1 H', n x q
  Eigen::MatrixXd term_factor_;    // lower factor of H K^-1 H', q x q
  LeftOut left_out_;
  Eigen::ArrayXd left_out_ratio_;  // n
};

}  // namespace twinmap::gp
