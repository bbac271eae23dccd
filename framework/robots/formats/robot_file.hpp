#pragma once

#include <string>

#include "framework/robots/robot_values.hpp"
#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

bool isMjcf(const XmlFile& file);

/// As readMjcf() or readUrdf().
Robot readRobot(const XmlFile& file);

/// As writeMjcf() or writeUrdf().
std::string writeRobot(const XmlFile& file, const Robot& robot, const RobotValues& values);

}  // namespace twinmap::robots
