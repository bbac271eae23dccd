#include "framework/robots/formats/robot_file.hpp"

#include "framework/robots/mjcf/read_mjcf.hpp"
#include "framework/robots/mjcf/write_mjcf.hpp"
#include "framework/robots/urdf/read_urdf.hpp"
#include "framework/robots/urdf/write_urdf.hpp"

namespace twinmap::robots {

bool isMjcf(const XmlFile& file) {
  return std::string(file.getRoot().name()) == "mujoco";
}

Robot readRobot(const XmlFile& file) {
  return isMjcf(file) ? readMjcf(file) : readUrdf(file);
}

std::string writeRobot(const XmlFile& file, const Robot& robot, const RobotValues& values) {
  return isMjcf(file) ? writeMjcf(file, robot, values) : writeUrdf(file, robot, values);
}

}  // namespace twinmap::robots
