#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/models/mechanism/equations/model_equations.hpp"
#include "framework/models/mechanism/lanes/recorded_excitation.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// A model written down once for all parameter sets. Parameters are those of collectSampled(); states the
/// coordinates in the order of SystemNames, then their speeds (Simbody's: see equations::JointMotion).
struct RecordedModel {
  using Symbols = std::vector<program::Symbol>;

  std::unique_ptr<program::Recorder> recorder;
  int parameter_count = 0, coordinate_count = 0;
  RecordedExcitation excitation;
  Symbols derivatives;  ///< of the states with respect to time
  Symbols pivots;       ///< not positive where the mass matrix is singular
  Symbols outputs;
  Symbols initial;             ///< states at t = 0; of parameters alone; without equilibrium
  Symbols rest_accelerations;  ///< at rest and t = 0 without excitation, of the coordinates
  Symbols rest_pivots;
  /// d/dt of [coordinates; their rates] linearised around rest, at t = 0 without excitation: entry (row,
  /// column) of the lower half, column by column (coordinates x 2 coordinates), at speeds 0.
  Symbols stiffness_and_damping;
};

/// Writes a model down. `box_center`: coordinates of the equilibrium that all samples start from, or empty.
/// Cost: some milliseconds.
RecordedModel recordModel(const ModelSpec& model, const SystemNames& names,
                          const Eigen::VectorXd& box_center);

}  // namespace twinmap
