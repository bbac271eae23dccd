#pragma once

#include <vector>

#include "kernels/tracking/tracker.hpp"

namespace twinmap::tracking {

/// All numbers of a state in a row, for a file; the same bits come back.
std::vector<double> flatten(const TrackerState& state);

/// Throws std::runtime_error where the numbers are not of a state of such a model.
TrackerState unflatten(const Model& model, const std::vector<double>& numbers);

}  // namespace twinmap::tracking
