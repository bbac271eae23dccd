#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/basins/basin.hpp"
#include "framework/estimation/ridges/sum_coordinates.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

struct PosteriorDrawOptions {
  int draws = 512;  ///< of a round; the error of a mean is then below a tenth of a standard deviation
  std::uint64_t seed = 1;
};

/// Basins in the coordinates in which they are sampled.
struct Landscape {
  std::vector<Basin> basins;
  std::vector<std::pair<std::size_t, std::size_t>> connected{};  // findConnections()
  bool is_straight = true;                                       // RidgeShape
  std::optional<double> nonlinearity{};  // calcNonlinearity() of the first basin, where it is known
};

/// The basins as they are seen in the first `drawn` coordinates alone.
std::vector<Basin> projectBasins(std::vector<Basin> basins, Eigen::Index drawn);

/// Draws of the first `kept` coordinates: about the only basin (areOneBasin) of more than kFewUnknown as if
/// the response were linear, if that is good enough; else of all basins by mixtures. Cost: a simulation a
/// draw; with derivatives, two, where coordinates are integrated out.
importance::AdaptiveDraws drawPosterior(MisfitSurface& surface, const Landscape& landscape, Eigen::Index kept,
                                        const PosteriorDrawOptions& options);

/// Draws of all coordinates, by mixtures in which sums stand for coordinates: their ridge is straight. The
/// surface's coordinates take the parameters that are replaced as they are.
importance::AdaptiveDraws drawInSums(MisfitSurface& surface, const std::vector<Basin>& basins,
                                     const SumCoordinates& sums, const PosteriorDrawOptions& options);

/// Draws of all coordinates where those of basins do not do, as of several flat directions that bend: chains
/// go through the valley first (walkPosterior), and the parts of the mixtures follow the response linearised
/// at their draws. Needed by a pendulum with LuGre friction whose start is unknown: of 30 posteriors 9 are
/// unreliable without. Cost: some 2500 simulations with derivatives, and twice as many draws a round.
importance::AdaptiveDraws drawAlongWalks(MisfitSurface& surface, const std::vector<Basin>& basins,
                                         const PosteriorDrawOptions& options);

}  // namespace twinmap
