#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/posterior/draws/posterior_draws.hpp"
#include "framework/estimation/posterior/problem_surface.hpp"

namespace twinmap {

/// Draws, and the coordinates in which they were drawn.
struct Sampling {
  std::vector<Eigen::Index> plain;  ///< of LogCoordinates
  Landscape landscape;
  importance::AdaptiveDraws drawn;
  std::string obstacle;  ///< why they are not to be believed; else empty
  int simulations = 0;   ///< of surfaces other than that of the searches
};

/// Whether a ridge of all unknown parameters may be followed round its bends: they are few, and all are
/// drawn.
bool mayBend(const PosteriorProblem& problem);

/// The straightest way first: along a bent ridge mixtures may find draws of a part of it good enough. Where
/// sums alone are determined, in these (drawInSums); from mixtures of the basins, with what is straighter as
/// it is (findRidgeShape); where that does not do, along walks (drawAlongWalks). Sums and walks where ridges
/// may bend (mayBend). whole: in logarithms, where the basins were found.
Sampling samplePosterior(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                         const PosteriorDrawOptions& options);

/// As if the response were linear about the best basin; none where responses that are linear about some of
/// these draws say otherwise (calcDisplacements). Those of a best fit that noise does not explain are not
/// asked: it is not to be believed anyway. Cost: eight simulations with derivatives.
std::optional<Sampling> sampleLinearModel(const PosteriorProblem& problem, const BasinSearch& found,
                                          ProblemSurface& whole, bool is_explained,
                                          const PosteriorDrawOptions& options);

}  // namespace twinmap
