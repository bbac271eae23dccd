#pragma once

#include "framework/robots/robot_values.hpp"
#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

/// The robot's file with new numbers: masses, centres and tensors in the frames that the file gives them in,
/// damping and friction. All other bytes are those of the file, and numbers that do not change too. `robot`:
/// of readUrdf(file).
std::string writeUrdf(const XmlFile& file, const Robot& robot, const RobotValues& values);

}  // namespace twinmap::robots
