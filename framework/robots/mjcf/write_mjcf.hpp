#pragma once

#include "framework/robots/robot_values.hpp"
#include "framework/robots/xml/xml_file.hpp"

namespace twinmap::robots {

/// The robot's MJCF with new numbers: masses, centres and tensors, damping, friction and armature. All other
/// bytes are those of the file; what a class, a default or a geom gave is added at the element. `robot`: of
/// readMjcf(file). Throws ExperimentError where an element is not in the file itself.
std::string writeMjcf(const XmlFile& file, const Robot& robot, const RobotValues& values);

}  // namespace twinmap::robots
