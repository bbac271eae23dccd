#pragma once

#include <Eigen/Core>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap::bench {

/// What a program in lanes does for one sample each time it is carried out, and how long that takes. A
/// multiply-add counts as 2 operations, a sine with its cosine as 40, all others as 1; bytes are those of the
/// operands and results that instructions load and store.
struct ProgramCost {
  int instructions = 0, dispatches = 0;
  double operations = 0.0, bytes = 0.0;
  double memory = 0.0;   ///< bytes of all values in all lanes
  double time_ns = 0.0;  ///< processor time; of all lanes together, divided by their number
};

/// How a batch of samples goes through the lanes.
struct LaneProfile {
  int lanes = 0;
  double steps = 0.0;           ///< tried, a sample
  double rejected_share = 0.0;  ///< of them
  double active_lanes = 0.0;    ///< mean over the rounds of a step in all lanes
  double evaluations = 0.0;     ///< of the derivative, a sample; those of idle lanes included
  ProgramCost derivative;       ///< of the states with respect to time
};

/// Integrates `points` (parameters x n), values alone, with as many lanes as suit them.
LaneProfile measureLanes(const ModelSpec& model, const Eigen::VectorXd& times, const Eigen::MatrixXd& points);

/// Independent multiply-adds whose values fit the first-level cache, in as many lanes as suit `samples`: the
/// rate that loads and stores allow.
ProgramCost measureMultiplyAdds(int samples);
/// The same of sines with their cosines: the rate that arithmetic allows, next to no loads and stores.
ProgramCost measureSines(int samples);

}  // namespace twinmap::bench
