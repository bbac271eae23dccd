#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace twinmap::bench {

using Point = Eigen::Ref<const Eigen::VectorXd>;

/// One mechanism, described twice: by an experiment file, and by MJCF with the functions that a user of
/// MuJoCo would write around it. Coordinates and outputs are the joints of the MJCF, in their order.
struct Mechanism {
  std::string name;
  std::string experiment, mjcf;        ///< files
  std::vector<std::string> overrides;  ///< of the experiment, so that its outputs are the coordinates

  /// Writes a parameter set into the model.
  void (*update)(const Point& parameters, mjModel& model);
  /// What the control loop applies for a whole step around `time` (s); null: nothing.
  void (*applyForces)(const Point& parameters, double time, mjData& data);
  /// What the control callback applies at each stage of a step; null: nothing.
  void (*applyStageForces)(const Point& parameters, mjData& data);
};

/// Two beams, six pins, crane, gantry.
std::vector<Mechanism> makeMechanisms();

/// Two beams, double pendulum on a cart, four masses in a chain, spatial arm.
std::vector<Mechanism> makeCurveMechanisms();

}  // namespace twinmap::bench
