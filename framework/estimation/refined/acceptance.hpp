#pragma once

#include "framework/estimation/refined/misfit.hpp"
#include "framework/estimation/refined/refined.hpp"

namespace twinmap {

/// What two tests say about a minimum.
struct Acceptance {
  RefinementStatus status = RefinementStatus::kAccepted;
  std::string message;
};

/// The largest chi-square that noise explains: the 99.9 % quantile for `degrees` of freedom.
double calcChiSquareLimit(double degrees);

/// That of a minimum (LocalMisfit::calcDegrees()).
double calcChiSquareLimit(const LocalMisfit& minimum);

/// Accepts a minimum if
/// - its chi-square is below the 99.9 % quantile for LocalMisfit::calcDegrees();
/// - the misfit rises along each eigenvector of the posterior covariance, on both sides, as its linear model
///   says: by 4 at 2 standard deviations, where 1 to 12 is accepted. That is a curvature within a factor 3 to
///   4, beyond which a standard deviation would be wrong by a factor of 2. Where the limits of the search
///   come first, the rise is that at the limit, and none is asked for within half a standard deviation: there
///   the box decides and not the model.
/// Cost: 2 s + 1 simulations, one batch. `along_ridge`: the eigenvector of largest variance is left out, as
/// its direction is followed by traceRidge().
Acceptance testMinimum(Misfit& misfit, const LocalMisfit& minimum, bool along_ridge = false);

/// The same of a minimum and of the misfits that were simulated with it.
Acceptance testProbed(const ProbedMisfit& minimum);

/// Where a misfit is held against its linear model, in standard deviations, and at least, beside bounds.
inline constexpr double kTestReach = 2.0, kMinTestReach = 0.5;

}  // namespace twinmap
