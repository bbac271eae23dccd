#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/basin_search.hpp"

namespace twinmap {

/// How a response bends about a basin's minimum: its second derivatives, from which posteriors of so many
/// parameters can be drawn that no weights make good what a linear response leaves out. With the residual
/// r - J z of the linear response, z in standard deviations along the principal axes of the basin's
/// covariance, the quadratic one is r - J z - sum_jk H_jk z_j z_k / 2.
class ResponseCurvature {
 public:
  /// H along each axis from the first derivatives half a standard deviation away, to the side with more room
  /// within the bounds; 0 along one that has hardly any, and for two of less than a tenth of the longest.
  /// None where a part's loss is not a sum of squares, or one of these points cannot be simulated. Cost: a
  /// simulation with derivatives for each of the longer axes.
  static std::optional<ResponseCurvature> measure(MisfitSurface& surface, const Basin& basin);

  /// Half of what the bend adds to the squared residual at a point (u). Cost: some u^2 times the number of
  /// directions in which responses bend.
  double calcBend(const Eigen::VectorXd& point) const;
  /// Its gradient (u).
  Eigen::VectorXd calcBendSlope(const Eigen::VectorXd& point) const;

 private:
  /// axes: u x u, orthogonal columns that are a standard deviation long.
  ResponseCurvature(const Eigen::VectorXd& at, const Eigen::MatrixXd& axes);

  /// From r (m), J (m x u) and the columns of H_jk, j <= k, times 1 or, of j = k, 1/2 (m x u (u + 1) / 2).
  void reduce(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& bends);

  /// z_j z_k of pairs_.
  Eigen::VectorXd multiplyPairs(const Eigen::VectorXd& z) const;

  Eigen::VectorXd at_;
  Eigen::MatrixXd to_axes_;                                   ///< u x u, the inverse of the axes
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs_;  ///< of axes j <= k whose H_jk is not 0
  Eigen::MatrixXd bends_;     ///< k x pairs, in the k directions in which responses bend
  Eigen::MatrixXd jacobian_;  ///< k x u, of the residual there
  Eigen::VectorXd residual_;  ///< k
};

}  // namespace twinmap
