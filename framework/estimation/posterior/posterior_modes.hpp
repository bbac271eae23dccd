#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"

namespace twinmap {

/// A place where the posterior has some of its mass, apart from the others.
struct PosteriorMode {
  double weight = 0.0;           ///< share of the posterior
  Eigen::VectorXd mean;          ///< u, in the parameters' units
  Eigen::VectorXd stddev;        ///< u
  double chi_square = 0.0;       ///< at its minimum
  Eigen::MatrixXd covariance{};  ///< u x u
};

/// The modes of weighted draws, at `points` (u x n, in the coordinates of the basins) and in the parameters'
/// units (`draws`, u x n), the heaviest first; those of less than a thousandth are left out. A draw belongs
/// to the nearest basin in its own metric; basins that are connected (findConnections), or that have no gap
/// between them, are one: a ridge, or a basin found twice.
std::vector<PosteriorMode> findModes(const Eigen::MatrixXd& points, const Eigen::MatrixXd& draws,
                                     const Eigen::VectorXd& weights, const std::vector<Basin>& basins,
                                     const std::vector<std::pair<std::size_t, std::size_t>>& connected);

}  // namespace twinmap
