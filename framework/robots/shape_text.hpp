#pragma once

#include <string>

#include "framework/robots/bodies.hpp"

namespace twinmap::robots {

/// The file of a mesh as an experiment beside the robot's file names it. One in a package of ROS is sought in
/// ROS_PACKAGE_PATH and above the robot's file; as it is where it is not there.
std::string locateMesh(const std::string& robot_file, const std::string& mesh);

/// Says of what does not move that it is not drawn: the ground has no shapes.
void noteGround(Robot& robot, const Assembly& assembly);

/// "      shapes:\n ..." of a body, with those of the links that are fixed to it; "" where nothing is drawn.
std::string writeShapes(const Robot& robot, const Assembly& assembly, const Link& body);

}  // namespace twinmap::robots
