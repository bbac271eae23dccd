#include "framework/models/mechanism/constraint_numbers.hpp"

namespace twinmap {
namespace {

ConstraintNumbers calcOneConstraint(const ConstraintSpec& spec, const SystemNames& names,
                                    ModelNumbers& numbers, const std::string& owner) {
  ConstraintNumbers one;
  if (spec.gear) {
    one.coordinate = names.findForcedCoordinate(spec.gear->coordinate);
    one.driver = names.findForcedCoordinate(spec.gear->driver);
    one.ratio = numbers.calc(spec.gear->ratio, {owner, "ratio", ""});
    one.offset = numbers.calc(spec.gear->offset, {owner, "offset", ""});
    return one;
  }
  const StationSpec& from = spec.coincident ? spec.coincident->from
                            : spec.rod      ? spec.rod->from
                                            : spec.point_in_plane->plane.station;
  const StationSpec& to = spec.coincident ? spec.coincident->to
                          : spec.rod      ? spec.rod->to
                                          : spec.point_in_plane->station;
  one.from = calcBodyPoint(from, names, numbers, owner);
  one.to = calcBodyPoint(to, names, numbers, owner);
  if (spec.rod) {
    one.length = numbers.calcPositive(spec.rod->length, {owner, "length", "m"});
  }
  if (spec.point_in_plane) {
    const Expression3& normal = spec.point_in_plane->plane.normal;
    one.normal = calcVector(numbers, normal, {owner, "normal", ""});
    if (one.normal.squaredNorm() == 0.0) {
      throw SimulationFailure(owner + ": normal must not be zero", normal[0].where);
    }
  }
  return one;
}

}  // namespace

std::vector<ConstraintNumbers> calcConstraintNumbers(const SystemSpec& spec, const SystemNames& names,
                                                     ModelNumbers& numbers) {
  std::vector<ConstraintNumbers> all;
  for (std::size_t i = 0; i < spec.constraints.size(); ++i) {
    const ConstraintSpec& constraint = spec.constraints[i];
    const std::string owner = constraint.name ? "constraint '" + constraint.name->text + "'"
                                              : "system.constraints[" + std::to_string(i) + "]";
    all.push_back(calcOneConstraint(constraint, names, numbers, owner));
  }
  return all;
}

}  // namespace twinmap
