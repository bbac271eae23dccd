#pragma once

#include <Eigen/Core>

namespace twinmap {

// What tests of recordings have in common, so that the same is noticed wherever it is looked at.

/// Standard deviations of a normal number that are exceeded once in a thousand times.
constexpr double kOnceInAThousand = 3.3;
/// Samples of which neighbours tell whether noise is white, or a clock right.
constexpr Eigen::Index kFewestTested = 20;

/// A simpler recording is taken for another where it leaves less of the misfit.
constexpr double kClearlyLess = 0.5;
/// An explanation stands for others where it takes more of the misfit beyond the noise.
constexpr double kMostOfMisfit = 0.9;

/// Chi-square a residual that sensors and units make, missing physics rarely, and what of it is left by that
/// which explains it.
constexpr double kGrossMisfit = 100.0, kRestOfGross = 0.01;

/// Draws that stand for a posterior where each is simulated with derivatives.
constexpr Eigen::Index kStandingDraws = 32;

}  // namespace twinmap
