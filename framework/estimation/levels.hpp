#pragma once

#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

/// What is called a mismatch or a contradiction although it is chance, once in a hundred.
constexpr double kMismatchLevel = 0.01;
/// What counts as impossible by chance, and a share that is left out: once in a thousand.
constexpr double kRareLevel = 1e-3;
/// kRareLevel in standard deviations of a normal distribution, both ways.
constexpr double kRareDeviations = 3.3;
/// chi-square above the best: for the same volume a place there bears a share of 4e-6 of the posterior. Also
/// the square of how many standard deviations apart two minima are two.
constexpr double kBasinAbove = 25.0;
/// Standard deviations within which nearly all of a normal distribution lies, and one basin.
constexpr double kBasinReach = 3.0;
/// chi-square rises by that between two normal distributions that are four standard deviations apart.
constexpr double kBarrier = 4.0;
/// Of chi-square, where a search need not go on: a tenth of a standard deviation.
constexpr double kLastGain = 0.01;
/// Of searches that end where another begins, or where little is wanted: across a valley, in a window, of
/// weights.
constexpr int kFewIterations = 8;
/// Of a direction, per half-width of the bounds: the data leave half of the standard deviation that the
/// bounds allow, sqrt(3 / (3 + information)) = 1/2, so that these decide.
constexpr double kFlatInformation = 3.0 * kHalfWidthInformation;
/// Of the standard deviation that the bounds allow: what is narrower is surely determined, half of what is
/// flat.
constexpr double kMayBeFlat = 0.25;
/// Of the largest diagonal, added to what may be singular; the square of kSameNumber.
constexpr double kRegular = 1e-12;
/// Of a number, a width or a spacing: what differs by less is the same, but for rounding and differences.
constexpr double kSameNumber = 1e-6;
/// Half-widths from the centre of the bounds: what is further out is at one, as searches end near it.
constexpr double kAtBound = 0.999;
/// Standard deviations: what moves an estimate by less, or adds less to a residual, is not worth a word.
constexpr double kImmaterial = 0.1;
/// Standard deviations by which something must move to be noticed: adds a tenth to what noise scatters, and
/// leaves 95 % intervals .92.
constexpr double kNoticeable = 0.5;
/// Samples, or scores, by which a number is told well: a parameter, a term of a regression, a correlation.
constexpr Eigen::Index kPerUnknown = 5;
/// Samples of which neighbours tell whether noise is white, or a clock right.
constexpr Eigen::Index kFewestTested = 20;
/// Of a misfit: a simpler recording is taken for another where it leaves less.
constexpr double kClearlyLess = 0.5;
/// Of a misfit beyond the noise: an explanation stands for others where it takes more.
constexpr double kMostOfMisfit = 0.9;
/// Chi-square a residual that sensors and units make, missing physics rarely, and what of it is left by that
/// which explains it.
constexpr double kGrossMisfit = 100.0, kRestOfGross = 0.01;
/// Whether what is left is so much that no noise is taken for it.
constexpr bool isGross(double chi_square, double degrees) {
  return chi_square > kGrossMisfit * degrees;
}
/// Of a gross misfit: where an iteration takes less, all that a search has left would not explain it. 25 of
/// them take a fifth.
constexpr double kCreeping = 0.01;
/// Draws that stand for a posterior where each is simulated with derivatives.
constexpr Eigen::Index kStandingDraws = 32;

}  // namespace twinmap
