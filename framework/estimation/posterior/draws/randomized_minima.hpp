#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

/// Independent draws about a basin's minimum of a posterior whose valley bends, by randomizing and then
/// minimising (Bardsley, Solonen, Haario and Laine, SIAM J. Sci. Comput. 36, 2014). With z in standard
/// deviations along the principal axes of the basin's covariance, the residual r - J z - sum_jk H_jk z_j z_k
/// / 2 of the measurement and the linear one of the prior, of which J and the prior's rows together have
/// orthonormal columns, each standard normal xi gives the z with
///   z + J' sum_jk H_jk z_j z_k / 2 = c + xi,
/// the least squares of measurements and priors with other errors. Where responses bend as H says and within
/// the range of J, that is the posterior; what is left is for weights.
class RandomizedMinima {
 public:
  /// H along each axis from the first derivatives half a standard deviation away, to the side with more room
  /// within the bounds; 0 along one that has hardly any, and for two of less than a tenth of the longest.
  /// None where a part's loss is not a sum of squares, or one of these points cannot be simulated. Cost: a
  /// simulation with derivatives for each of the longer axes.
  static std::optional<RandomizedMinima> measure(MisfitSurface& surface, const Basin& basin);

  struct Draw {
    Eigen::VectorXd point;     ///< u
    double log_density = 0.0;  ///< but for a summand
  };
  /// From standard normal numbers (u); none where no z on this side of a fold of the map is found. Cost: some
  /// ten times u^3 flops.
  std::optional<Draw> draw(const Eigen::VectorXd& normals) const;

 private:
  struct Pair {
    Eigen::Index j, k;  ///< j <= k
    Eigen::VectorXd bend;
  };

  /// axes: u x u, orthogonal columns that are a standard deviation long.
  RandomizedMinima(Eigen::VectorXd at, Eigen::MatrixXd axes, Eigen::VectorXd offset)
      : at_(std::move(at)), axes_(std::move(axes)), offset_(std::move(offset)) {}

  /// bends: of each axis j, the columns J' H_jk (u x u); steps: 0 for axes of which there are none.
  void pairBends(const std::vector<Eigen::MatrixXd>& bends, const Eigen::VectorXd& steps);

  Eigen::VectorXd bend(const Eigen::VectorXd& z) const;        ///< z + J' sum_jk H_jk z_j z_k / 2
  Eigen::MatrixXd calcSlopes(const Eigen::VectorXd& z) const;  ///< of bend() (u x u)
  /// bend() = wanted, by Newton's method from 0.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& wanted) const;

  Eigen::VectorXd at_;
  Eigen::MatrixXd axes_;
  Eigen::VectorXd offset_;   ///< c
  std::vector<Pair> pairs_;  ///< with J' H_jk, of j = k its half
};

/// The posterior by rounds of such draws (importance::drawInRounds), each weighted by its density over
/// theirs. Cost: a simulation a draw.
importance::AdaptiveDraws sampleRandomizedMinima(MisfitSurface& surface, const RandomizedMinima& minima,
                                                 int draws, int most_rounds, std::uint64_t seed);

}  // namespace twinmap
