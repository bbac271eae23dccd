#pragma once

#include "framework/estimation/posterior/misfit_surface.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

/// Whether draws end where the posterior goes on, as those of a bent valley do that were drawn in a small
/// part of it alone: nothing in their own weights shows that. Each coordinate is held five standard
/// deviations of the draws from their mean, both ways, and the others are searched for the least misfit
/// there: a point of the profile likelihood. Of a normal posterior it lies 25 above the least of all; of
/// right draws of valleys with several flat directions it was seen to lie 1.8 and more above, of draws of a
/// quarter of a valley .05 to 1. Coordinates whose bound lies nearer than four standard deviations say
/// nothing: the bound ends them. Cost: a search of at most 6 iterations for each end.
bool endTooEarly(MisfitSurface& surface, const importance::WeightedDraws& draws, double least_misfit);

}  // namespace twinmap
