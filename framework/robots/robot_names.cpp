#include "framework/robots/robot_names.hpp"

#include <cctype>

#include "framework/experiment/expression/expression.hpp"

namespace twinmap::robots {
namespace {

/// A coordinate has names for its rates too.
constexpr const char* kSuffixes[] = {"", "_dot", "_ddot"};

std::string takeFree(const std::string& wish, std::set<std::string>& taken, bool with_rates) {
  std::string name = makeIdentifier(wish);
  const auto isTaken = [&](const std::string& one) {
    return taken.count(one) > 0 ||
           (with_rates && (taken.count(one + "_dot") > 0 || taken.count(one + "_ddot") > 0));
  };
  while (isReservedName(name) || isTaken(name)) {
    name += '_';
  }
  for (const char* suffix : kSuffixes) {
    taken.insert(name + suffix);
    if (!with_rates) {
      break;
    }
  }
  return name;
}

}  // namespace

std::string makeIdentifier(const std::string& text) {
  constexpr std::size_t kLongest = 60;  // characters: parameters of it are below the 100 of a key
  std::string name;
  for (const char c : text.substr(0, kLongest)) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128 ? c : '_';
  }
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 ? "_" + name : name;
}

RobotNames::RobotNames(const Robot& robot) {
  std::set<std::string> taken{"ground"};
  for (const Link& link : robot.links) {
    links_[link.name] = takeFree(link.name, taken, false);
  }
  taken.clear();
  for (const Joint& joint : robot.joints) {
    joints_[joint.name] = takeFree(joint.name, taken, false);
    if (joint.isSingle()) {
      coordinates_[joint.name] = takeFree(joint.name, taken_, true);
    }
  }
}

const std::vector<std::string>& RobotNames::takeCoordinates(const Body& body) {
  std::vector<std::string>& names = of_bodies_[body.link];
  if (!names.empty()) {
    return names;
  }
  const Joint* joint = body.joint;
  const auto add = [&](std::initializer_list<const char*> suffixes) {
    for (const char* suffix : suffixes) {
      names.push_back(takeFree((joint != nullptr ? joint->name : body.link->name) + suffix, taken_, true));
    }
  };
  if (joint != nullptr && joint->isSingle()) {
    names.push_back(getCoordinate(joint->name));
  } else if (body.is_free_base || (joint != nullptr && joint->kind == JointKind::kFloating)) {
    add({"_rx", "_ry", "_rz", "_x", "_y", "_z"});
  } else if (joint != nullptr && joint->kind == JointKind::kBall) {
    add({"_rx", "_ry", "_rz"});
  } else if (joint != nullptr) {
    add({"_angle", "_x", "_y"});
  }
  return names;
}

std::string RobotNames::take(const std::string& wish) {
  return takeFree(wish, taken_, false);
}

}  // namespace twinmap::robots
