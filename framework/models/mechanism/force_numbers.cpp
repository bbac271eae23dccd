#include "framework/models/mechanism/force_numbers.hpp"

namespace twinmap {
namespace {

std::array<double, 6> calcSix(const std::vector<Expression>& expressions, NumberEvaluator& numbers,
                              const Name& near, const Quantity& quantity) {
  if (expressions.size() != 6) {
    throw ExperimentError(near.where, near.text,
                          std::string("is on a bushing whose ") + quantity.name + " is not six numbers");
  }
  std::array<double, 6> values{};
  for (int i = 0; i < 6; ++i) {
    values[i] = numbers.calc(expressions[i], quantity);
  }
  return values;
}

std::string describeEnds(const char* kind, const StationSpec& from, const StationSpec& to) {
  return std::string(kind) + " from '" + from.body.text + "' to '" + to.body.text + "'";
}

void addCoordinateForces(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers,
                         PassiveForces& forces) {
  for (const SpringSpec& spring : spec.springs) {
    const std::string owner = "spring on '" + spring.coordinate.text + "'";
    forces.springs.push_back({names.findForcedCoordinate(spring.coordinate),
                              numbers.calc(spring.stiffness, {owner, "stiffness", ""}),
                              numbers.calc(spring.rest, {owner, "rest", ""})});
  }
  for (const DamperSpec& damper : spec.dampers) {
    const std::string owner = "damper on '" + damper.coordinate.text + "'";
    forces.dampers.push_back({names.findForcedCoordinate(damper.coordinate),
                              numbers.calc(damper.damping, {owner, "damping", ""})});
  }
}

void addTwoPointForces(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers,
                       PassiveForces& forces) {
  for (const TwoPointSpringSpec& spring : spec.two_point_springs) {
    const std::string owner = describeEnds("two-point spring", spring.from, spring.to);
    forces.two_point_springs.push_back({calcStation(spring.from, names, numbers, owner),
                                        calcStation(spring.to, names, numbers, owner),
                                        numbers.calc(spring.stiffness, {owner, "stiffness", "N/m"}),
                                        numbers.calc(spring.rest_length, {owner, "rest_length", "m"})});
  }
  for (const TwoPointDamperSpec& damper : spec.two_point_dampers) {
    const std::string owner = describeEnds("two-point damper", damper.from, damper.to);
    forces.two_point_dampers.push_back({calcStation(damper.from, names, numbers, owner),
                                        calcStation(damper.to, names, numbers, owner),
                                        numbers.calc(damper.damping, {owner, "damping", "N s/m"})});
  }
}

FramedBody calcFramedBody(const BodyFrameSpec& spec, const SystemNames& names, NumberEvaluator& numbers) {
  return {names.findBody(spec.body), calcFrame(spec.frame, numbers, "bushing on '" + spec.body.text + "'")};
}

void addBushings(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers,
                 PassiveForces& forces) {
  for (const BushingSpec& bushing : spec.bushings) {
    const std::string owner =
        "bushing from '" + bushing.from.body.text + "' to '" + bushing.to.body.text + "'";
    forces.bushings.push_back({calcFramedBody(bushing.from, names, numbers),
                               calcFramedBody(bushing.to, names, numbers),
                               calcSix(bushing.stiffness, numbers, bushing.to.body, {owner, "stiffness", ""}),
                               calcSix(bushing.damping, numbers, bushing.to.body, {owner, "damping", ""})});
  }
}

}  // namespace

Station calcAppliedStation(const AppliedForceSpec& force, const SystemNames& names,
                           NumberEvaluator& numbers) {
  return calcStation(force.station, names, numbers, "force on '" + force.station.body.text + "'");
}

PassiveForces calcPassiveForces(const SystemSpec& spec, const SystemNames& names, NumberEvaluator& numbers) {
  PassiveForces forces;
  forces.gravity = calcVector(numbers, spec.gravity, {"system", "gravity", "m/s2"});
  addCoordinateForces(spec, names, numbers, forces);
  addTwoPointForces(spec, names, numbers, forces);
  addBushings(spec, names, numbers, forces);
  return forces;
}

}  // namespace twinmap
