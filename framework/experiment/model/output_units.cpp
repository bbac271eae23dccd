#include "framework/experiment/model/output_units.hpp"

#include <algorithm>

#include "framework/experiment/model/named_forces.hpp"

namespace twinmap {

namespace {

std::optional<CoordinateKind> findKind(const SystemSpec& system, const std::string& coordinate) {
  for (const BodySpec& body : system.bodies) {
    const JointCoordinates& kinds = getJointCoordinates(body.joint.type);
    for (std::size_t i = 0; i < std::min(kinds.size(), body.joint.coordinates.size()); ++i) {
      if (body.joint.coordinates[i].text == coordinate) {
        return kinds[i].kind;
      }
    }
  }
  return {};
}

/// Of what is not a component.
std::string findForceUnit(const Name& name, const SystemSpec& system) {
  const std::optional<NamedForce> force = findNamedForce(system, name.text);
  const std::optional<CoordinateKind> kind =
      force && force->coordinate ? findKind(system, force->coordinate->text) : std::nullopt;
  return getForceUnit(kind.value_or(CoordinateKind::kTranslation));
}

}  // namespace

const char* getOutputUnit(const OutputSpec& output, CoordinateKind kind) {
  if (output.coordinate || output.speed) {
    return output.coordinate ? getUnit(kind) : getSpeedUnit(kind);
  }
  return output.position ? "m" : output.velocity ? "m/s" : output.angular_velocity ? "rad/s" : "m/s2";
}

std::string findOutputUnit(const OutputSpec& output, const SystemSpec& system) {
  if (output.variable || !output.expression.text.empty()) {
    return output.unit;
  }
  if (output.reaction || output.component) {
    return getForceUnit(output.reaction ? output.reaction->component : *output.component);
  }
  if (output.force_of) {
    return findForceUnit(*output.force_of, system);
  }
  if (!output.coordinate && !output.speed) {
    return getOutputUnit(output, {});
  }
  const std::optional<CoordinateKind> kind =
      findKind(system, (output.coordinate ? output.coordinate : output.speed)->text);
  return kind ? getOutputUnit(output, *kind) : "";
}

}  // namespace twinmap
