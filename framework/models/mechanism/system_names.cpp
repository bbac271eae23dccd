#include "framework/models/mechanism/system_names.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

int find(const std::vector<std::string>& names, const Name& name, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name.text);
  if (found == names.end()) {
    throw ExperimentError(name.where, name.text,
                          std::string("is not ") + what + suggestName(name.text, names));
  }
  return static_cast<int>(found - names.begin());
}

void addOnce(std::vector<std::string>& names, const Name& name) {
  if (contains(names, name.text)) {
    throw ExperimentError(name.where, name.text, "is declared twice");
  }
  names.push_back(name.text);
}

void checkJoint(const BodySpec& body) {
  const int count = getCoordinateCount(body.joint.type);
  if (static_cast<int>(body.joint.coordinates.size()) != count) {
    throw ExperimentError(
        body.name.where, body.name.text,
        fmt::format("needs {} coordinate names for its joint, not {}", count, body.joint.coordinates.size()));
  }
  if (body.joint.axis && !hasAxis(body.joint.type)) {
    throw ExperimentError((*body.joint.axis)[0].where, "", "must not be given: this joint has no axis");
  }
}

}  // namespace

SystemNames::SystemNames(const SystemSpec& system) {
  for (const BodySpec& body : system.bodies) {
    addBody(body);
  }
  is_prescribed_.resize(coordinates_.size());
  for (const MotionSpec& motion : system.motions) {
    is_prescribed_[static_cast<std::size_t>(findCoordinate(motion.coordinate))] = true;
  }
  addStates(system);
  forces_ = listNamedForces(system);
}

void SystemNames::addBody(const BodySpec& body) {
  checkJoint(body);
  find(body_names_, body.joint.parent, "\"ground\" or a body declared before");
  addOnce(body_names_, body.name);
  addOnce(joint_names_, getJointName(body));
  addCoordinates(body.joint, static_cast<int>(body_names_.size()) - 1);
}

void SystemNames::addCoordinates(const JointSpec& joint, int body) {
  const JointCoordinates& traits = getJointCoordinates(joint.type);
  for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
    addOnce(coordinate_names_, joint.coordinates[i]);
    coordinates_.push_back({body, static_cast<int>(i), traits[i]});
  }
}

void SystemNames::addStates(const SystemSpec& system) {
  for (const StateSpec& state : system.states) {
    addOnce(state_names_, state.name);
  }
  system.elements.forEachList([this](const auto& list) {
    for (const auto& element : list) {
      forEachOwnState(element, [this](const auto& part, const Name& coordinate) {
        const std::string unnamed =
            fmt::format("state {} (on '{}')", state_names_.size() + 1, coordinate.text);
        addOnce(state_names_, part.state.value_or(Name{unnamed, coordinate.where}));
      });
    }
  });
}

int SystemNames::findBody(const Name& name) const {
  return find(body_names_, name, "a body");
}

int SystemNames::findCoordinate(const Name& name) const {
  return find(coordinate_names_, name, "a coordinate");
}

int SystemNames::findJoint(const Name& name) const {
  const int body = find(joint_names_, name, "a joint");
  if (body == 0) {
    throw ExperimentError(name.where, name.text, "has no joint");
  }
  return body;
}

const NamedForce& SystemNames::findForce(const Name& name) const {
  std::vector<std::string> names;
  for (const NamedForce& force : forces_) {
    names.push_back(force.name.text);
  }
  return forces_[find(
      names, name, "the name of a force element or constraint, or a coordinate whose motion is prescribed")];
}

int SystemNames::findForcedCoordinate(const Name& name) const {
  const int index = findCoordinate(name);
  if (!coordinates_[index].traits.takes_forces) {
    throw ExperimentError(name.where, name.text,
                          "is an angle of a ball or free joint, whose speed is not its derivative: use a "
                          "bushing or an applied moment, or a gimbal or bushing joint");
  }
  return index;
}

}  // namespace twinmap
