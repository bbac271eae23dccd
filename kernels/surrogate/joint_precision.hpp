#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/surrogate/joint_fit.hpp"

namespace twinmap::gp {

/// The inverse A of a joint covariance K of n values and u m slopes, of which fits follow that leave out some
/// of the points: with F the rows left out and S the others,
///   K_SS^-1 = A_SS - A_SF A_FF^-1 A_FS,
/// so that the folds of a cross-validation share one factorisation. Weights are refined once with K, which
/// takes from them what rounding in A costs where K is nearly singular.
class JointPrecision {
 public:
  /// points: p x n; slopes are known at the first m of them. Cost: (n + u m)^3 flops; 2 (n + u m)^2 numbers.
  JointPrecision(const SharedStructure& structure, const SharedHyperparameters& hyperparameters,
                 const Eigen::MatrixXd& points, Eigen::Index slope_points, Eigen::Index variables);

  /// Whether K has a Cholesky factor. If not, nothing can be fitted.
  bool isDefinite() const { return definite_; }

  /// As fitJointly() for the points `kept` alone (rising). `values` and `slopes` are theirs: the slopes of
  /// those below m. False where it cannot. Cost, with k rows kept and f left out: 6 (n + u m)^2 r + 2 f k (q
  /// + r) + f^2 (k + f / 3) flops.
  bool fitPoints(const std::vector<Eigen::Index>& kept, const Eigen::MatrixXd& values,
                 const SlopeData& slopes, JointFit& fit) const;

 private:
  struct Part;
  Part take(const std::vector<Eigen::Index>& kept) const;
  std::vector<Eigen::Index> listRows(const std::vector<Eigen::Index>& points) const;

  Eigen::VectorXd length_scales_;
  Eigen::Index points_, slope_points_, variables_;
  Eigen::MatrixXd covariance_, precision_;  // K and A
  Eigen::MatrixXd terms_, solved_terms_;    // H', n + u m x q, and A H'
  bool definite_ = false;
};

}  // namespace twinmap::gp
