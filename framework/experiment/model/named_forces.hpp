#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

/// A force element or constraint that has a name, or the motion of a coordinate, as outputs of its force see
/// it.
struct NamedForce {
  Name name;
  const char* noun = "";             ///< "two-point spring", "rod"
  ForceParts parts{};                ///< what of it can be shown
  std::optional<Name> coordinate{};  ///< that it acts on, if it does
  int kind = -1, index = -1;         ///< of an element: its kind by the order of forEachType, its place there
  int constraint = -1;               ///< or its place among the constraints
  int motion = -1;                   ///< or among the prescribed motions
};

/// Whether an element has a name, so that outputs can show its force.
template <class Element, class = void>
inline constexpr bool kHasOwnName = false;
template <class Element>
inline constexpr bool kHasOwnName<Element, std::void_t<decltype(Element::name)>> = true;

/// Elements in the order of the file's keys, then constraints, then motions, which are called by their
/// coordinates.
std::vector<NamedForce> listNamedForces(const SystemSpec& system);

/// Null: none has that name.
std::optional<NamedForce> findNamedForce(const SystemSpec& system, const std::string& name);

/// "coincident", "rod" ...: the key of its kind.
const char* getKind(const ConstraintSpec& constraint);

/// By which outputs call a joint: its own name, or that of its body.
inline const Name& getJointName(const BodySpec& body) {
  return body.joint.name ? *body.joint.name : body.name;
}

}  // namespace twinmap
