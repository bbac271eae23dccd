#include "framework/experiment/model/named_forces.hpp"

#include <algorithm>

#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

template <class Element, class = void>
constexpr bool kActsOnCoordinate = false;
template <class Element>
constexpr bool kActsOnCoordinate<Element, std::void_t<decltype(Element::coordinate)>> = true;

template <class Element>
void addElements(const std::vector<Element>& elements, int kind, std::vector<NamedForce>& forces) {
  if constexpr (kHasOwnName<Element>) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!elements[i].name) {
        continue;
      }
      forces.push_back(
          {*elements[i].name, Element::kKind.noun, Element::kKind.parts, {}, kind, static_cast<int>(i)});
      if constexpr (kActsOnCoordinate<Element>) {
        forces.back().coordinate = elements[i].coordinate;
      }
    }
  }
}

ForceParts getParts(const ConstraintSpec& constraint) {
  const bool moment = constraint.weld || constraint.pin;
  const bool along = constraint.rod || constraint.point_in_plane || constraint.gear || constraint.rolling;
  return {along, !constraint.gear, moment};
}

}  // namespace

const char* getKind(const ConstraintSpec& constraint) {
  return constraint.coincident       ? "coincident"
         : constraint.rod            ? "rod"
         : constraint.point_in_plane ? "point_in_plane"
         : constraint.gear           ? "gear"
         : constraint.weld           ? "weld"
         : constraint.pin            ? "pin"
                                     : "rolling";
}

std::vector<NamedForce> listNamedForces(const SystemSpec& system) {
  std::vector<NamedForce> forces;
  int kind = 0;
  system.elements.forEachList([&](const auto& list) { addElements(list, kind++, forces); });
  for (std::size_t i = 0; i < system.constraints.size(); ++i) {
    const ConstraintSpec& constraint = system.constraints[i];
    if (constraint.name) {
      forces.push_back({*constraint.name, getKind(constraint), getParts(constraint)});
      forces.back().constraint = static_cast<int>(i);
      if (constraint.gear) {
        forces.back().coordinate = constraint.gear->coordinate;
      }
    }
  }
  for (std::size_t i = 0; i < system.motions.size(); ++i) {
    const Name& moved = system.motions[i].coordinate;
    forces.push_back({moved, "prescribed motion", {true, false, false}, moved});
    forces.back().motion = static_cast<int>(i);
  }
  return forces;
}

std::optional<NamedForce> findNamedForce(const SystemSpec& system, const std::string& name) {
  const std::vector<NamedForce> forces = listNamedForces(system);
  const auto found = std::find_if(forces.begin(), forces.end(),
                                  [&](const NamedForce& force) { return force.name.text == name; });
  return found == forces.end() ? std::nullopt : std::make_optional(*found);
}

}  // namespace twinmap
