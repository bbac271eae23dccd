#pragma once

#include "framework/models/mechanism/lanes/lane_start.hpp"
#include "framework/models/mechanism/modes.hpp"

namespace twinmap {

/// Modes of the system linearised at each sample's own equilibrium, from exact derivatives.
class LaneModes {
 public:
  explicit LaneModes(const LaneModel& model);

  /// The matrix of x' = A x at an equilibrium (LaneStart's), of the degrees of freedom that loops leave.
  Eigen::MatrixXd calcMatrix(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                             const Eigen::VectorXd& equilibrium);

  /// The `count` lowest frequencies (Hz), then their damping ratios, at an equilibrium (LaneStart's). Throws
  /// SimulationFailure if fewer oscillate.
  Eigen::VectorXd calc(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                       const Eigen::VectorXd& equilibrium, int count);

 private:
  const LaneModel& model_;
  std::optional<SingleProgram> program_;  ///< when first used
  std::optional<Assembly> assembly_;      ///< with loops
};

}  // namespace twinmap
