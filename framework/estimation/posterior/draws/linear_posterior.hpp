#pragma once

#include <cstdint>

#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

/// With more unknown parameters than these the posterior of one basin is first tried as one whose response is
/// linear: mixtures that follow any shape need some ten draws a dimension.
constexpr Eigen::Index kFewUnknown = 8;

/// The posterior about the only basin, of any number of parameters. Draws come from the posterior that it
/// would be if the response were linear about the basin's minimum: a normal likelihood, but the prior and the
/// bounds as they are, so that what the measurement does not determine keeps its prior exactly
/// (sampleEllipticalSlices, without a simulation). Each is weighted by its likelihood over the linear one:
/// the effective sample size and the Pareto shape show where the response is too far from linear for that.
/// Rounds of `draws` (importance::drawInRounds). Cost: one simulation a draw, whatever the number of
/// parameters.
importance::AdaptiveDraws sampleLinearized(MisfitSurface& surface, const Basin& basin, int draws,
                                           int most_rounds, std::uint64_t seed);

/// Draws of that posterior as it would be if the response were linear, of equal weight: no simulation.
importance::AdaptiveDraws drawLinear(const MisfitSurface& surface, const Basin& basin, int draws,
                                     std::uint64_t seed);

/// How far the linear response about a basin's minimum is to be believed: of each coordinate, by how many of
/// its standard deviations the responses that are linear about `points` (u x n), some of its own draws, put
/// the mean elsewhere (root mean square). The misfit of these draws says less: where a valley bends it is
/// large, though the mean and standard deviation of each parameter are right. Infinite where one of them
/// cannot be simulated. Cost: a simulation with derivatives of each.
Eigen::VectorXd calcDisplacements(MisfitSurface& surface, const Basin& basin, const Eigen::MatrixXd& points);

/// How far from linear the response is where that posterior has its mass: the variance of the logarithms of
/// some draws' weights, infinite where one of them cannot be simulated. What is straight in the parameters is
/// bent in their logarithms, and the other way about.
double calcNonlinearity(MisfitSurface& surface, const Basin& basin, std::uint64_t seed);

/// Whether the minima are one basin for that: the measurement does not keep them apart, so that they differ
/// in what it leaves to the prior alone. Nothing keeps them apart that the first one's linear response says
/// is below five standard deviations of the noise.
bool areOneBasin(const MisfitSurface& surface, const std::vector<Basin>& basins);

/// Few searches where more than kManyUnknown parameters are drawn: no number of them covers the bounds, each
/// takes a simulation with as many derivatives a step, and a machine of many parameters has priors, as which
/// they are spread.
BasinSearchOptions limitSearch(BasinSearchOptions options, Eigen::Index drawn);

/// Points to search from (u x n, or none at all): where more than kManyUnknown of the u parameters are drawn
/// and none is given, the prior's median.
Eigen::MatrixXd addMedian(const Eigen::MatrixXd& given, const Prior& prior, Eigen::Index unknown,
                          Eigen::Index drawn);

}  // namespace twinmap
