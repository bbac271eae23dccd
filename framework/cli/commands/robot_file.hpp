#pragma once

#include <string>

#include "framework/robots/robot_values.hpp"
#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::cli {

bool isMjcf(const robots::XmlFile& file);

/// As readMjcf() or readUrdf().
robots::Robot readRobot(const robots::XmlFile& file);

/// As writeMjcf() or writeUrdf().
std::string writeRobot(const robots::XmlFile& file, const robots::Robot& robot,
                       const robots::RobotValues& values);

}  // namespace twinmap::cli
