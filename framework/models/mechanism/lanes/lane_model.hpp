#pragma once

#include <memory>

#include "framework/models/mechanism/lanes/recorded_model.hpp"
#include "kernels/lanes/problem.hpp"

namespace twinmap {

/// The programs of a model that all threads share; immutable. Symbols: see RecordedModel.
struct LaneModel {
  program::InputCounts counts;
  RecordedExcitation excitation;  ///< its symbols are not to be used
  lanes::Problem problem;         ///< the motion and its outputs
  program::Program start;  ///< initial states, then events; with directions their derivatives, one by one
  program::Program rest;   ///< rest_accelerations, rest_pivots, d accelerations / d coordinates by columns;
                           ///< with directions also d accelerations / d parameters by columns
  program::Program linearization;
  int directions = 0;  ///< 0, or all parameters
};

/// Compiles a recorded model, for its values alone or also for the derivatives with respect to all
/// parameters. Appends to the recorder. Cost: milliseconds; with derivatives as much more as there are
/// parameters.
LaneModel compileModel(const RecordedModel& recorded, bool with_derivatives);

/// The derivatives of the states' derivatives with respect to the states, column by column. Appends to the
/// recorder.
program::Program compileJacobian(const RecordedModel& recorded);

}  // namespace twinmap
