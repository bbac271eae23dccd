#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/misfit_surface.hpp"

namespace twinmap {

/// A minimum of chi-square within the bounds.
struct Basin {
  LocalSurface local;
  Eigen::MatrixXd covariance;  ///< u x u: of the linear model, with the box as a normal distribution
  int searches = 0;            ///< that ended in it
};

/// What searches from all over the box found.
struct BasinSearch {
  std::vector<Basin> basins;  ///< the least chi-square first; empty where no start could be simulated
  int starts = 0;
};

struct BasinSearchOptions {
  /// Starts, of a Sobol sequence. With 64, a basin that attracts a twentieth of the box is missed once in 27
  /// measurements by the first batch.
  int starts = 64;
  /// Batches of starts follow until the best basin was found this often, or so many batches were searched:
  /// a basin found once may have a better neighbour that was not found at all.
  int confirmations = 3;
  int max_batches = 4;
  int max_iterations = 25;
};

/// The minima of a surface that may bear some of the posterior: chi-square at most 25 above the best. All
/// searches go side by side, by Levenberg and Marquardt's method with three dampings an iteration, so that an
/// iteration is a batch of simulations and one of derivatives; parameters at a bound whose descent points
/// outwards are held. After 5 and after 10 iterations those far above the best are given up. Where the best
/// end is not explained by noise and the response has windows that grow (RefinementModel), all are searched
/// again from windows that grow. `given`: points (u x n, may be empty) to search from as well. The starts
/// depend on `seed` alone. Cost: some 20 to 40 simulations a start.
BasinSearch findBasins(MisfitSurface& surface, const Eigen::MatrixXd& given, std::uint64_t seed,
                       const BasinSearchOptions& options = {});

}  // namespace twinmap
