#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// Fewer points do not show how a ridge bends.
constexpr std::size_t kMinRidgePoints = 3;

/// Parameters that can be changed together without a change of the features, and how, at several points.
struct FlatDirections {
  std::vector<Eigen::Index> parameters;  ///< g, ascending
  Eigen::Index dimension = 0;  ///< r, of the changes: g - r functions of the parameters are identified
  std::vector<Eigen::MatrixXd> changes;  ///< n of g x r, orthonormal, in widths of the bounds
  Eigen::MatrixXd points;                ///< p x n, where they are
  /// n of g x g: the covariance there of what is determined, in widths, with the box as a normal
  /// distribution.
  std::vector<Eigen::MatrixXd> determined;
};

/// The flat directions of the Fisher information, in groups that have no parameter in common. `information`:
/// of each point (p x p, per width; empty where unknown); `points`: p x n. A direction is flat where the data
/// leave more than half of the standard deviation that the bounds allow. A parameter takes part with 3 % of a
/// flat direction's square on average. One that is well determined but for that takes part from .12 % on. Of
/// a group the points count that have the commonest number of flat directions in it; a group for which these
/// are fewer than half of all, or than 3, is left out, and so is one of a single parameter. Cost: 9 p^3 flops
/// a point.
std::vector<FlatDirections> findFlatDirections(const std::vector<Eigen::MatrixXd>& information,
                                               const Eigen::MatrixXd& points);

/// Whether there may be flat directions where a posterior with this covariance (p x p, in widths of the
/// bounds) has its mass and the prior is uniform: none where it is narrower in every direction than a quarter
/// of what the bounds allow, half of what is flat.
bool mayBeFlat(const Eigen::MatrixXd& covariance);

}  // namespace twinmap
