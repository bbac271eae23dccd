#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/models/start_states.hpp"

namespace twinmap {

/// About where the states of segments are, and how far they may be from there.
struct StateGuess {
  Eigen::MatrixXd states;  ///< s x S
  Eigen::VectorXd scales;  ///< s, above 0
};

/// Samples of a segment: rows times, a column an output of the model; NaN where missing.
using SegmentSamples = std::vector<Eigen::MatrixXd>;

/// Of a coordinate that an output measures, and of its speed, from a straight line through the first samples
/// of each segment; the scale is their spread over the segments. Of others what the file gives for the start,
/// at the centre of the bounds; the scale is the half-width of the bounds of the parameter that it is there,
/// or as large as it is, or, where it is 0, that of the states of its kind that are measured.
StateGuess guessStates(const ModelSpec& model, const std::vector<StartState>& states, double interval,
                       const SegmentSamples& samples);

}  // namespace twinmap
