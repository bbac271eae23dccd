#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/robots/inertia.hpp"

namespace twinmap::robots {

/// New numbers of a robot, by the names of its links and joints.
struct RobotValues {
  std::map<std::string, MassProperties> links;
  std::map<std::string, double> damping, friction, armature;
  std::vector<std::string> without_place;  ///< parameters that the robot's file has no number for
  bool exist = true;                       ///< masses and spreads are above 0, losses not below
};

/// The numbers that an estimate changes: parameters by the names that the import gives them. Of a link's
/// spread and skew, what is not a parameter is the file's. Throws ExperimentError for a parameter whose name
/// fits nothing; `source`: where the estimate is from.
RobotValues placeValues(const Robot& robot, const std::map<std::string, double>& values,
                        const std::string& source);

}  // namespace twinmap::robots
