#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/basins/basin.hpp"

namespace twinmap {

/// Points all over the box (u x n) to search from: of a Sobol sequence.
Eigen::MatrixXd makeStarts(Eigen::Index dimensions, std::uint64_t seed, int count);

/// Whether a basin's search came to its minimum, as near as searches of so many parameters go (choosePace).
bool hasArrived(const Basin& basin);

/// What searches from all over the box found.
struct BasinSearch {
  std::vector<Basin> basins;  ///< the least chi-square first; empty where no start could be simulated
  int starts = 0;
};

struct BasinSearchOptions {
  /// Searches before anything is known, of a Sobol sequence as all starts; as many again and again, up to
  /// `starts`, where noise explains the best end but too few have found it.
  int scouts = 16;
  /// Where the scouts agree, so many points more are looked at from the basins: a basin that attracts a
  /// twentieth of the box has three of them in it.
  int probes = 64;
  /// Else so many searches, the scouts among them: a basin that attracts a twentieth of the box is missed
  /// once in 27 measurements by the first batch.
  int starts = 64;
  /// Batches of starts follow until the best basin was found this often, or so many batches were searched:
  /// a basin found once may have a better neighbour that was not found at all.
  int confirmations = 3;
  int max_batches = 4;
  int max_iterations = 25;
  /// Whether starts are spread as the prior is, not all over the bounds: of many parameters hardly any start
  /// is near enough else.
  bool from_prior = false;
  /// Whether noise need not explain the best basin: for models that lack something, whose best fit is wanted
  /// but not trusted. It ends the search where it was found often enough, as the second batch does. The basin
  /// is then as wide as if the noise were as large as the residual. Batches always do of a gross misfit, and
  /// where no search explains the beginning of the response.
  bool settles = false;
};

/// The minima of a surface that may bear some of the posterior: chi-square at most 25 above the best.
/// Searches go side by side (SearchTeam). Where the first of them agree on a basin that noise explains,
/// points all over the box follow, each with the way to it from the nearest basin: if chi-square does not
/// rise all along the way, a search starts where it falls again by more than noise does. Else more searches
/// follow; where the best end is not explained by noise and the response has windows that grow
/// (RefinementModel), all are searched again from windows that grow. `given`: points (u x n, may be empty) to
/// search from as well. The starts depend on `seed` alone. Cost: some 10 simulations, 5 of them with
/// derivatives, a search; 3 a probe.
BasinSearch findBasins(MisfitSurface& surface, const Eigen::MatrixXd& given, std::uint64_t seed,
                       const BasinSearchOptions& options = {});

}  // namespace twinmap
