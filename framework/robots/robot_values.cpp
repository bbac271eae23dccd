#include "framework/robots/robot_values.hpp"

#include <algorithm>
#include <set>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/robots/robot_names.hpp"

namespace twinmap::robots {
namespace {

class Placing {
 public:
  Placing(const Robot& robot, const std::map<std::string, double>& values)
      : robot_(robot), names_(robot), values_(values) {
    placeNowhere(names_.take("g"));
    for (const Link& link : robot.links) {
      if (link.hasMass()) {
        placeLink(link);
      }
    }
    for (const Joint& joint : robot.joints) {
      if (joint.isSingle()) {
        placeJoint(joint);
      }
    }
  }

  RobotValues finish(const std::string& file, const std::string& source) {
    for (const auto& [name, value] : values_) {
      if (known_.count(name) == 0) {
        throw ExperimentError(source + ": parameter '" + name + "' fits nothing in " + file +
                              ": call it as import does (link_mass, joint_damping ...), or leave it out" +
                              suggestName(name, std::vector<std::string>(known_.begin(), known_.end())));
      }
    }
    return std::move(placed_);
  }

 private:
  const double* find(const std::string& name) {
    known_.insert(name);
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : &found->second;
  }

  /// Whether there is a new value.
  bool read(const std::string& wish, double& value) {
    const double* found = find(names_.take(wish));
    value = found != nullptr ? *found : value;
    return found != nullptr;
  }
  bool read(const std::string& owner, const char* const (&suffixes)[3], Vector& values) {
    const bool x = read(owner + suffixes[0], values.x), y = read(owner + suffixes[1], values.y),
               z = read(owner + suffixes[2], values.z);
    return x || y || z;
  }

  void exist(bool does) { placed_.exist = placed_.exist && does; }

  void placeNowhere(const std::string& name) {
    if (find(name) != nullptr) {
      placed_.without_place.push_back(name);
    }
  }

  void placeLink(const Link& link) {
    const std::string& name = names_.getBody(link.name);
    MassProperties mass = calcMassProperties(*link.inertial);
    Spread spread = calcSpread(mass);
    const bool mass_is_new = read(name + "_mass", mass.mass);
    const bool center_is_new = read(name, {"_cx", "_cy", "_cz"}, mass.center);
    const bool spread_is_new = read(name, {"_lx", "_ly", "_lz"}, spread.spread);
    const bool skew_is_new = read(name, {"_sxy", "_sxz", "_syz"}, spread.skew);
    if (mass_is_new || spread_is_new || skew_is_new) {
      mass.tensor = calcTensor(mass.mass, spread);
    }
    if (mass_is_new || center_is_new || spread_is_new || skew_is_new) {
      placed_.links[link.name] = mass;
      exist(std::min({mass.mass, spread.spread.x, spread.spread.y, spread.spread.z}) > 0.0);
    }
  }

  void placeJoint(const Joint& joint) {
    const std::string& name = names_.getCoordinate(joint.name);
    double damping = joint.damping, friction = joint.friction;
    if (read(name + "_damping", damping)) {
      placed_.damping[joint.name] = damping;
      exist(damping >= 0.0);
    }
    if (read(name + "_friction", friction)) {
      placed_.friction[joint.name] = friction;
      exist(friction >= 0.0);
    }
    if (!robot_.actuators) {  // a URDF has no place for it
      placeNowhere(names_.take(name + "_armature"));
    } else if (double armature = joint.armature; read(name + "_armature", armature)) {
      placed_.armature[joint.name] = armature;
      exist(armature >= 0.0);
    }
  }

  const Robot& robot_;
  RobotNames names_;
  const std::map<std::string, double>& values_;
  std::set<std::string> known_;
  RobotValues placed_;
};

}  // namespace

RobotValues placeValues(const Robot& robot, const std::map<std::string, double>& values,
                        const std::string& source) {
  return Placing(robot, values).finish(robot.file, source);
}

}  // namespace twinmap::robots
