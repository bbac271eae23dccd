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
  if (spec.weld || spec.pin) {
    const AttachedFrameSpec& from = spec.weld ? spec.weld->from : spec.pin->from;
    const AttachedFrameSpec& to = spec.weld ? spec.weld->to : spec.pin->to;
    one.from_frame = calcFrame(from.frame, numbers, owner);
    one.to_frame = calcFrame(to.frame, numbers, owner);
    one.from = {names.findBody(from.body), one.from_frame.point};
    one.to = {names.findBody(to.body), one.to_frame.point};
    return one;
  }
  if (spec.point_in_plane || spec.rolling) {
    const PlaneSpec& plane = spec.rolling ? spec.rolling->plane : spec.point_in_plane->plane;
    one.from = {names.findBody(plane.body), calcVector(numbers, plane.point, {owner, "point", "m"})};
    one.to = calcBodyPoint(spec.rolling ? spec.rolling->center : spec.point_in_plane->station, names, numbers,
                           owner);
    one.normal = calcVector(numbers, plane.normal, {owner, "normal", ""});
    if (one.normal.squaredNorm() == 0.0) {
      throw SimulationFailure(owner + ": normal must not be zero", plane.normal[0].where);
    }
    if (spec.rolling) {
      one.length = numbers.calcPositive(spec.rolling->radius, {owner, "radius", "m"});
    }
    return one;
  }
  one.from = calcBodyPoint(spec.coincident ? spec.coincident->from : spec.rod->from, names, numbers, owner);
  one.to = calcBodyPoint(spec.coincident ? spec.coincident->to : spec.rod->to, names, numbers, owner);
  if (spec.rod) {
    one.length = numbers.calcPositive(spec.rod->length, {owner, "length", "m"});
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
