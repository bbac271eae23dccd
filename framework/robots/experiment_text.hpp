#pragma once

#include <string>
#include <vector>

#include "framework/robots/import_options.hpp"
#include "framework/robots/robot.hpp"

namespace twinmap::robots {

/// An experiment file that describes the robot, with what it leaves out at its head. `robot.left_out` gets
/// what this finds. Throws ExperimentError as assembleBodies() does, and for parameters that the file gives
/// no value or limit for.
std::string makeExperimentText(Robot& robot, const ImportOptions& options);

/// Lines for people: "robot.urdf:12, 40: <visual>: a drawing; it moves nothing".
std::vector<std::string> describeLeftOut(const Robot& robot);

}  // namespace twinmap::robots
