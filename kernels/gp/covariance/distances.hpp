#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/linalg/triangular.hpp"
#include "kernels/linalg/view.hpp"

namespace twinmap::gp {

/// Squared distances between n samples under length scales shared by groups of features, and the
/// contractions of their derivatives, without an n x n x d array:
///   q_ij = sum_g D_g,ij / l_g^2,   D_g,ij = sum over features f of group g of (x_fi - x_fj)^2.
/// Up to kMaxStoredGroups groups, the matrices D_g are stored (8 n^2 bytes each) and an evaluation is one
/// pass over them. With more groups, q comes from one product Z' Z of the scaled inputs Z = X / l, and
/// gradients from one product Z T (see contract). Both depend on the sizes only, never on the thread count.
class SquaredDistances {
 public:
  static constexpr int kMaxStoredGroups = 4;

  /// inputs: d x n, centred (the products lose digits otherwise); groups[f] in [0, group_count).
  SquaredDistances(const Eigen::MatrixXd& inputs, std::vector<int> groups, int group_count);

  Eigen::Index size() const { return inputs_.cols(); }
  int getGroupCount() const { return group_count_; }

  /// Buffers of one thread.
  struct Workspace {
    explicit Workspace(const SquaredDistances& distances);
    Eigen::MatrixXd scaled;         ///< Z, d x n, rows padded; empty when the D_g are stored
    Eigen::MatrixXd product;        ///< Z T
    Eigen::VectorXd squared_norms;  ///< |z_i|^2
    Eigen::VectorXd row_sums;       ///< of T + T'
    Eigen::VectorXd feature_sums;   ///< one per feature
  };

  /// Writes q's strict lower triangle; the diagonal, the rows above it in the same cache line and the padding
  /// rows become zero. q: n x n within columns of padded(n) rows. Cost: n^2 G / 2 or n^2 d flops.
  void calc(const Eigen::VectorXd& length_scales, linalg::View q, Workspace& workspace,
            linalg::TriangularScratch& scratch) const;

  /// sums(g) = sum over i > j of T_ij D_g,ij / l_g^2, for T strictly lower triangular with zeros elsewhere,
  /// by
  ///   sum_{i>j} T_ij (z_i - z_j)^2 = sum_i r_i z_i^2 - 2 z' T z,   r = (T + T') 1.
  /// Must follow calc with the same length scales and workspace. Cost: n^2 G or n^2 d flops.
  void contract(const Eigen::VectorXd& length_scales, linalg::View t, Workspace& workspace,
                linalg::TriangularScratch& scratch, Eigen::VectorXd& sums) const;

 private:
  bool isStored() const { return group_count_ <= kMaxStoredGroups; }
  void storeGroups();
  void calcFromGroups(const Eigen::VectorXd& length_scales, linalg::View q) const;
  void calcFromProduct(const Eigen::VectorXd& length_scales, linalg::View q, Workspace& workspace,
                       linalg::TriangularScratch& scratch) const;
  void contractGroups(const Eigen::VectorXd& length_scales, linalg::View t, Eigen::VectorXd& sums) const;
  void contractProduct(linalg::View t, Workspace& workspace, linalg::TriangularScratch& scratch,
                       Eigen::VectorXd& sums) const;

  Eigen::MatrixXd inputs_;  // d x n
  std::vector<int> groups_;
  int group_count_;
  std::vector<Eigen::MatrixXd> stored_;  // D_g, padded(n) x n, strictly lower
};

}  // namespace twinmap::gp
