#include "framework/experiment/expression/output_units.hpp"

#include <algorithm>

namespace twinmap {

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
  if (!output.coordinate && !output.speed) {
    return getOutputUnit(output, {});
  }
  const std::string& wanted = (output.coordinate ? output.coordinate : output.speed)->text;
  for (const BodySpec& body : system.bodies) {
    const JointCoordinates& kinds = getJointCoordinates(body.joint.type);
    for (std::size_t i = 0; i < std::min(kinds.size(), body.joint.coordinates.size()); ++i) {
      if (body.joint.coordinates[i].text == wanted) {
        return getOutputUnit(output, kinds[i].kind);
      }
    }
  }
  return "";
}

}  // namespace twinmap
