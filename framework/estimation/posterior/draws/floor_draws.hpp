#pragma once

#include <cstdint>
#include <vector>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"

namespace twinmap {

/// What is known across valleys, as draws about places on their floors. How much of the posterior each place
/// bears is not known well, so that they say something of what hardly changes along the valleys alone.
struct FloorDraws {
  Eigen::MatrixXd points;     ///< u x n, in the parameters' units, within the bounds
  Eigen::VectorXd weights;    ///< n, sum 1; 0 of places themselves and of steps along the valley
  std::vector<int> places{};  ///< n, about which of them, ascending
  /// n, of steps: how many standard deviations of what is left open there they are less than one; 0 of others
  Eigen::VectorXd scales{};

  bool isGiven() const { return weights.size() > 0; }
  /// Whether something is determined of which these are the values (n) at the points. From place to place it
  /// changes by no more than it does about each, so that at most half of its variance depends on where the
  /// places are; and steps along the valley would add a tenth of the variance at most, which is left out, so
  /// that standard deviations are short by 5 %. At least three places must bear weight, or nothing is known
  /// of how it changes. bench/determined.py measures how this holds (docs/benchmarks/posterior.md).
  bool determine(const Eigen::VectorXd& values) const;
};

/// About each place its linear model's normal distribution within the bounds, across the valley alone: in the
/// directions of which the measurement leaves less than a quarter of what the bounds allow, as mayBeFlat()
/// asks. Places are left out that are more than a standard deviation off the floor; the others weigh as their
/// misfit says. The result depends on `seed` alone. Without simulations.
FloorDraws drawAcrossValleys(const std::vector<LocalSurface>& places, const LogCoordinates& coordinates,
                             std::uint64_t seed);

}  // namespace twinmap
