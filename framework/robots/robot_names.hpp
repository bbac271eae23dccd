#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "framework/robots/bodies.hpp"

namespace twinmap::robots {

/// What the experiment calls links, joints and coordinates: as the robot's file does, but that what is not a
/// letter, digit or '_' becomes '_', and what is taken or reserved ends in '_'. The same for the same file.
class RobotNames {
 public:
  explicit RobotNames(const Robot& robot);

  const std::string& getBody(const std::string& link) const { return links_.at(link); }
  const std::string& getJoint(const std::string& joint) const { return joints_.at(joint); }
  /// Of a joint that turns or slides.
  const std::string& getCoordinate(const std::string& joint) const { return coordinates_.at(joint); }
  /// Of a body's joint, in the order of the experiment's joint type; the same names at each call.
  const std::vector<std::string>& takeCoordinates(const Body& body);
  /// A name for a parameter or signal, "joint1_damping".
  std::string take(const std::string& wish);

 private:
  std::map<std::string, std::string> links_, joints_, coordinates_;
  std::map<const Link*, std::vector<std::string>> of_bodies_;
  std::set<std::string> taken_;
};

/// Letters, digits and '_' alone, no digit first.
std::string makeIdentifier(const std::string& text);

}  // namespace twinmap::robots
