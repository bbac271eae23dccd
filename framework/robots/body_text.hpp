#pragma once

#include <string>

#include "framework/robots/robot_import.hpp"

namespace twinmap::robots {

/// "    NAME:\n ..." of a body: its mass, its joint, what it looks like. Adds the parameters of its inertia,
/// and to `robot.left_out` what no body has.
std::string writeBody(RobotImport& import, const Body& body);

}  // namespace twinmap::robots
