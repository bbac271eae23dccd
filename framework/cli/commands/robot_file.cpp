#include "framework/cli/commands/robot_file.hpp"

#include "framework/robots/mjcf/read_mjcf.hpp"
#include "framework/robots/mjcf/write_mjcf.hpp"
#include "framework/robots/urdf/read_urdf.hpp"
#include "framework/robots/urdf/write_urdf.hpp"

namespace twinmap::cli {

bool isMjcf(const robots::XmlFile& file) {
  return std::string(file.getRoot().name()) == "mujoco";
}

robots::Robot readRobot(const robots::XmlFile& file) {
  return isMjcf(file) ? robots::readMjcf(file) : robots::readUrdf(file);
}

std::string writeRobot(const robots::XmlFile& file, const robots::Robot& robot,
                       const robots::RobotValues& values) {
  return isMjcf(file) ? robots::writeMjcf(file, robot, values) : robots::writeUrdf(file, robot, values);
}

}  // namespace twinmap::cli
