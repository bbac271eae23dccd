#pragma once

#include "kernels/tracking/smoother.hpp"
#include "kernels/tracking/tracker.hpp"

namespace twinmap::tracking {

/// What is known of each parameter (p) at each of N measurements: by those until then, and by all.
struct WholeCourse {
  std::vector<bool> used;  ///< N
  Course filtered, smoothed;
};

/// Runs a tracker through all measurements (in order) and smooths what it used. Smoothed values integrate
/// over unknown rates as filtered ones do. O(N (rates + changes supposed) k n^2).
WholeCourse calcWholeCourse(const Model& model, const std::vector<Measurement>& measurements);

}  // namespace twinmap::tracking
