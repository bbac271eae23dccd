#pragma once

#include <cstdint>
#include <vector>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"

namespace twinmap {

/// What is known across valleys, as draws about places on their floors. How much of the posterior each place
/// bears is not known well, so that they say something of what hardly changes along the valleys alone.
struct FloorDraws {
  Eigen::MatrixXd points;     ///< u x n, in the parameters' units, within the bounds
  Eigen::VectorXd weights;    ///< n, sum 1
  std::vector<int> places{};  ///< n, about which of them, ascending

  bool isGiven() const { return weights.size() > 0; }
  /// Whether something is determined of which these are the values (n) at the draws: from place to place it
  /// changes by no more than it does about each, so that at most half of its variance depends on where the
  /// places are. At least three of them must bear weight, or nothing is known of how it changes.
  bool determine(const Eigen::VectorXd& values) const;
};

/// About each place its linear model's normal distribution within the bounds, across the valley alone: in the
/// directions of which the measurement leaves less than a quarter of what the bounds allow, as mayBeFlat()
/// asks. Places are left out that are more than a standard deviation off the floor; the others weigh as their
/// misfit says. The result depends on `seed` alone. Without simulations.
FloorDraws drawAcrossValleys(const std::vector<LocalSurface>& places, const LogCoordinates& coordinates,
                             std::uint64_t seed);

}  // namespace twinmap
