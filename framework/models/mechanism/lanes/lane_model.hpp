#pragma once

#include <memory>

#include "framework/models/mechanism/lanes/recorded_model.hpp"
#include "kernels/lanes/problem.hpp"

namespace twinmap {

/// The programs of a model that all threads share; immutable. Symbols: see RecordedModel.
struct LaneModel {
  program::InputCounts counts;
  int coordinate_count = 0;
  int hidden_count = 0;           ///< states of sensors and controllers
  RecordedExcitation excitation;  ///< its symbols are not to be used
  RecordedSampling sampling;      ///< likewise
  lanes::Problem problem;         ///< the motion and its outputs
  program::Program start;  ///< initial states, events, delays; with directions their derivatives, one by one
  program::Program rest;   ///< rest_rates, rest_pivots, d rest_rates / d [coordinates; states of first order]
                           ///< by columns; with directions also d rest_rates / d parameters by columns
  program::Program linearization;
  int directions = 0;  ///< 0, or all parameters

  int getFirstOrderCount() const { return counts.states - 2 * coordinate_count - hidden_count; }
};

/// Compiles a recorded model, for its values alone or also for the derivatives with respect to all
/// parameters. Appends to the recorder. Cost: milliseconds; with derivatives as much more as there are
/// parameters.
LaneModel compileModel(const RecordedModel& recorded, bool with_derivatives);

/// The derivatives of the states' derivatives with respect to the states, column by column. Appends to the
/// recorder.
program::Program compileJacobian(const RecordedModel& recorded);

}  // namespace twinmap
