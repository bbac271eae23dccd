#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/robots/bodies.hpp"
#include "framework/robots/recording.hpp"

namespace twinmap::robots {

struct ImportOptions {
  Base base = Base::kFixed;
  std::vector<std::string> parameters;   ///< inertia, friction, armature, damping
  std::vector<std::string> joints;       ///< that move; empty: all
  std::optional<Recording> recording{};  ///< whose columns are called as coordinates and signals
  bool from_motion = false;              ///< the motion is known, and what drives exert is measured
  bool stops = false;                    ///< limits of joints become rigid stops
  double relative_stddev = 0.2;          ///< of the parameters' priors
};

/// An experiment file that describes the robot, with what it leaves out at its head. `robot.left_out` gets
/// what this finds. Throws ExperimentError as assembleBodies() does, and for parameters that the file gives
/// no value or limit for.
std::string makeExperimentText(Robot& robot, const ImportOptions& options);

/// Lines for people: "robot.urdf:12, 40: <visual>: a drawing; it moves nothing".
std::vector<std::string> describeLeftOut(const Robot& robot);

}  // namespace twinmap::robots
