#pragma once

#include <optional>
#include <vector>

#include "framework/estimation/posterior/basins/valley.hpp"
#include "framework/estimation/ridges/sum_coordinates.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

struct PosteriorDrawOptions {
  int draws = 512;  ///< of a round; the error of a mean is then below a tenth of a standard deviation
  std::uint64_t seed = 1;
};

/// Basins and the valleys between them, in the coordinates in which they are sampled.
struct Landscape {
  std::vector<Basin> basins;
  Valleys valleys;
  bool is_straight = true;               // RidgeShape
  std::optional<double> nonlinearity{};  // calcNonlinearity() of the first basin, where it is known
};

/// The basins as they are seen in the first `drawn` coordinates alone.
std::vector<Basin> projectBasins(std::vector<Basin> basins, Eigen::Index drawn);

/// Draws of the first `kept` coordinates: about the only basin (areOneBasin) of more than kFewUnknown as if
/// the response were linear, if that is good enough; else of all basins by mixtures, on the floors of valleys
/// too, which are followed then. Cost: a simulation a draw; with derivatives, two, where coordinates are
/// integrated out.
importance::AdaptiveDraws drawPosterior(MisfitSurface& surface, Landscape& landscape, Eigen::Index kept,
                                        const PosteriorDrawOptions& options);

/// Draws of all coordinates, by mixtures in which sums stand for coordinates: their ridge is straight. The
/// surface's coordinates take the parameters that are replaced as they are.
importance::AdaptiveDraws drawInSums(MisfitSurface& surface, const std::vector<Basin>& basins,
                                     const SumCoordinates& sums, const PosteriorDrawOptions& options);

/// Draws of all coordinates where those of basins and valleys do not do, as several flat directions that bend
/// have more ends than valleys are followed to: chains go through the valley first (walkPosterior), and the
/// parts of the mixtures follow the response linearised at their draws. Cost: some 2500 simulations with
/// derivatives, and twice as many draws a round.
importance::AdaptiveDraws drawAlongWalks(MisfitSurface& surface, const std::vector<Basin>& basins,
                                         const PosteriorDrawOptions& options);

}  // namespace twinmap
