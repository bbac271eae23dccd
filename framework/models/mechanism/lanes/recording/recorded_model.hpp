#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "framework/models/mechanism/equations/model_equations.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_events.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_excitation.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_sampling.hpp"
#include "framework/models/mechanism/loops/loop_model.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// A model written down once for all parameter sets. Parameters are those of collectSampled(); states the
/// coordinates in the order of SystemNames, then their speeds (Simbody's: see equations::JointMotion), then
/// the states of first order, the modes of switches, and last the states of sensors and controllers that no
/// expression sees.
struct RecordedModel {
  using Symbols = std::vector<program::Symbol>;

  std::unique_ptr<program::Recorder> recorder;
  int parameter_count = 0, coordinate_count = 0;
  int state_count = 0;        ///< of first order, without modes and hidden ones
  int mode_count = 0;         ///< states of switches: their modes, and what is watched for their events
  int origin_parameter = -1;  ///< ModelSpec::time_origin, among the parameters
  RecordedExcitation excitation;
  Symbols derivatives;        ///< of the states with respect to time
  Symbols pivots;             ///< not positive where the mass matrix or a loop is singular
  RecordedSampling sampling;  ///< with the outputs; only the rates of its states are also in `derivatives`
  RecordedEvents events;
  Symbols initial;  ///< states at t = 0; of parameters alone, and what is prescribed of the first phase's
                    ///< inputs; without equilibrium. With loops as the file gives them, and rates of
                    ///< coordinates in the place of speeds: Assembly's
  /// Where what follows, at rest, is not recorded yet: the same once more, with it.
  std::function<RecordedModel()> record_with_rest;
  Symbols rest_rates;  ///< at rest and t = 0 without excitation: accelerations, then rates of the states of
                       ///< first order
  Symbols rest_closures;  ///< distances from the independent conditions of loops, as accelerations
  Symbols rest_pivots;
  /// d/dt of [coordinates; their rates; states of first order] linearised around rest, at t = 0 without
  /// excitation: all rows but those of the coordinates, column by column, at speeds 0.
  Symbols linearization;
  std::vector<int> prescribed;  ///< coordinates that move as signals say; at the start in `initial`
  std::shared_ptr<const LoopModel> loops;  ///< null: none
  Symbols projected;                       ///< with loops: the states nearest that meet the conditions
  Symbols relaxed;  ///< with loops: derivatives that lead to the conditions, for implicit integration
};

/// Writes a model down. `loops`: makeLoopModel() of the model, or null where it has no constraints. Models of
/// many coordinates that do not begin at rest are recorded without it; they must outlive the record. Cost:
/// some milliseconds.
RecordedModel recordModel(const ModelSpec& model, const SystemNames& names,
                          std::shared_ptr<const LoopModel> loops = nullptr);

}  // namespace twinmap
