#pragma once

#include "framework/models/mechanism/lanes/lane_start.hpp"
#include "framework/models/mechanism/modes.hpp"

namespace twinmap {

/// Modes of the system linearised at each sample's own equilibrium, from exact derivatives.
class LaneModes {
 public:
  explicit LaneModes(const LaneModel& model);

  /// The `count` lowest frequencies (Hz), then their damping ratios, at an equilibrium. Throws
  /// SimulationFailure if fewer oscillate.
  Eigen::VectorXd calc(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                       const Eigen::VectorXd& coordinates, int count);

 private:
  Eigen::Index coordinate_count_;
  SingleProgram program_;
};

}  // namespace twinmap
