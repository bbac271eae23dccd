#include "framework/models/mechanism/system_numbers.hpp"

#include <cmath>

#include "framework/experiment/model/output_units.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Vector3d;

/// A moment may break a rule by this much of the largest one: rounding of thin plates and rods.
constexpr double kInertiaSlack = 1e-9;

Vector3d calcPrincipalMoments(const Vector3d& moments, const Vector3d& products) {
  Eigen::Matrix3d tensor;
  tensor << moments[0], products[0], products[1],  //
      products[0], moments[1], products[2],        //
      products[1], products[2], moments[2];
  return linalg::calcSymmetricEigenvalues(tensor);
}

void checkInertia(const std::string& owner, const Vector3d& principal, const SourceLocation& where) {
  const double slack = kInertiaSlack * principal.cwiseAbs().maxCoeff();
  if (principal[0] < -slack) {
    throwUnusable({owner, "inertia: smallest principal moment", "kg m2"}, principal[0],
                  "must not be negative", where);
  }
  if (principal[2] > principal[0] + principal[1] + slack) {
    throwUnusable({owner, "inertia: largest principal moment", "kg m2"}, principal[2],
                  "must not exceed the sum of the other two (of a body that turns about one axis alone, only "
                  "the moment J about that axis acts: write [J, J, J])",
                  where);
  }
}

/// Accelerations need m c^2 and 1 / m, which must be numbers.
void checkRange(const BodySpec& body, const std::string& owner, double mass, const Vector3d& center) {
  if (!std::isfinite(1.0 / mass)) {
    throwUnusable({owner, "mass", "kg"}, mass, "is too small: its inverse must be finite", body.mass.where);
  }
  if (!std::isfinite(mass * center.squaredNorm())) {
    throwUnusable({owner, "center_of_mass", "m"}, center.stableNorm(),
                  "is too far away: the inertia about the body's origin must be finite",
                  body.center_of_mass[0].where);
  }
}

std::string findUnit(const OutputSpec& output, const SystemNames& names) {
  if (!output.expression.text.empty()) {
    return output.unit;
  }
  if (output.reaction || output.component) {
    return getForceUnit(output.reaction ? output.reaction->component : *output.component);
  }
  if (output.force_of) {
    const std::optional<Name> on = names.findForce(*output.force_of).coordinate;
    return getForceUnit(on ? names.getCoordinates()[names.findCoordinate(*on)].traits.kind
                           : CoordinateKind::kTranslation);
  }
  const std::optional<Name>& coordinate = output.coordinate ? output.coordinate : output.speed;
  return getOutputUnit(output, coordinate
                                   ? names.getCoordinates()[names.findCoordinate(*coordinate)].traits.kind
                                   : CoordinateKind{});
}

void checkOne(const OutputSpec& output) {
  const int count = output.coordinate.has_value() + output.speed.has_value() + output.position.has_value() +
                    output.velocity.has_value() + output.acceleration.has_value() +
                    output.specific_force.has_value() + output.angular_velocity.has_value() +
                    output.reaction.has_value() + output.force_of.has_value() +
                    (output.expression.text.empty() ? 0 : 1);
  if (count != 1) {
    throw ExperimentError(output.name.where, output.name.text,
                          "must measure one of coordinate, speed, position, velocity, acceleration, "
                          "specific_force, angular_velocity, reaction, force_of, expression");
  }
}

Vector3d calcDirection(const Expression3& given, ModelNumbers& numbers, const std::string& owner) {
  const Vector3d direction = calcVector(numbers, given, {owner, "direction", ""});
  const double length = std::sqrt(direction.squaredNorm());
  if (length == 0.0) {
    throw SimulationFailure(owner + ": direction must not be zero", given[0].where);
  }
  return direction / length;
}

OutputNumbers calcQuantity(const OutputSpec& spec, const SystemNames& names, ModelNumbers& numbers,
                           const std::string& owner) {
  if (spec.coordinate || spec.speed) {
    const Name& name = spec.coordinate ? *spec.coordinate : *spec.speed;
    const OutputKind kind = spec.coordinate ? OutputKind::kCoordinate : OutputKind::kSpeed;
    return {kind, names.findCoordinate(name), {0, Vector3d::Zero()}, Vector3d::Zero(), nullptr, {}};
  }
  if (!spec.expression.text.empty()) {
    return {OutputKind::kExpression, -1, {0, Vector3d::Zero()}, Vector3d::Zero(), &spec.expression, {}};
  }
  if (spec.reaction) {
    return {OutputKind::kReaction,   -1,      {names.findJoint(spec.reaction->joint), Vector3d::Zero()},
            Vector3d::Zero(),        nullptr, {},
            spec.reaction->component};
  }
  if (spec.force_of) {
    return {OutputKind::kForce,
            -1,
            {0, Vector3d::Zero()},
            Vector3d::Zero(),
            nullptr,
            {},
            spec.component,
            &names.findForce(*spec.force_of)};
  }
  if (spec.specific_force || spec.angular_velocity) {
    const BodySensorSpec& at = spec.specific_force ? *spec.specific_force : *spec.angular_velocity;
    const OutputKind kind = spec.specific_force ? OutputKind::kSpecificForce : OutputKind::kAngularVelocity;
    const BodyPoint point = calcBodyPoint(at.station, names, numbers, owner);
    return {kind, -1, point, calcDirection(at.direction, numbers, owner), nullptr, {}};
  }
  const StationOutputSpec& at = spec.position   ? *spec.position
                                : spec.velocity ? *spec.velocity
                                                : *spec.acceleration;
  const OutputKind kind = spec.position   ? OutputKind::kPosition
                          : spec.velocity ? OutputKind::kVelocity
                                          : OutputKind::kAcceleration;
  const BodyPoint station = calcBodyPoint(at.station, names, numbers, owner);
  return {kind, -1, station, calcDirection(at.direction, numbers, owner), nullptr, {}};
}

}  // namespace

Vector3d calcVector(ModelNumbers& numbers, const Expression3& expressions, const Quantity& quantity) {
  const std::array<double, 3> values = numbers.calc3(expressions, quantity);
  return {values[0], values[1], values[2]};
}

FrameNumbers calcFrame(const FrameSpec& frame, ModelNumbers& numbers, const std::string& owner) {
  const Vector3d angles = calcVector(numbers, frame.orientation, {owner, "orientation", "rad"});
  return {calcVector(numbers, frame.point, {owner, "point", "m"}), angles};
}

MassNumbers calcMassNumbers(const BodySpec& body, ModelNumbers& numbers) {
  const std::string owner = "body '" + body.name.text + "'";
  MassNumbers mass{};
  const bool is_frame = body.massless.value_or(false);
  mass.mass = is_frame ? numbers.calc(body.mass, {owner, "mass", "kg"})
                       : numbers.calcPositive(body.mass, {owner, "mass", "kg"});
  mass.center = calcVector(numbers, body.center_of_mass, {owner, "center_of_mass", "m"});
  const Expression& about_axis = body.inertia.about_axis;
  mass.moments = about_axis.text.empty()
                     ? calcVector(numbers, body.inertia.moments, {owner, "inertia.moments", "kg m2"})
                     : Vector3d::Constant(numbers.calc(about_axis, {owner, "inertia", "kg m2"}));
  mass.products = calcVector(numbers, body.inertia.products, {owner, "inertia.products", "kg m2"});
  if (!is_frame) {
    checkRange(body, owner, mass.mass, mass.center);
  } else if (mass.mass != 0.0 || !mass.moments.isZero(0.0) || !mass.products.isZero(0.0)) {
    throw SimulationFailure(owner + ": is massless, so its mass and inertia must be 0", body.mass.where);
  }
  if (!isUnchecked(body.inertia)) {
    checkInertia(owner, calcPrincipalMoments(mass.moments, mass.products),
                 about_axis.text.empty() ? body.inertia.moments[0].where : about_axis.where);
  }
  return mass;
}

void checkArmature(const ArmatureSpec& armature, ModelNumbers& numbers) {
  const Quantity quantity{"armature of '" + armature.coordinate.text + "'", "inertia", "kg m2"};
  const double inertia = numbers.calc(armature.inertia, quantity);
  if (inertia < 0.0) {
    throwUnusable(quantity, inertia, "must not be negative", armature.inertia.where);
  }
}

JointNumbers calcJointNumbers(const BodySpec& body, ModelNumbers& numbers) {
  const std::string owner = "body '" + body.name.text + "'";
  JointNumbers joint;
  if (body.joint.axis) {
    joint.axis = calcVector(numbers, *body.joint.axis, {owner, "joint.axis", ""});
    if (joint.axis->squaredNorm() == 0.0) {
      throw SimulationFailure(owner + ": joint.axis must not be zero", (*body.joint.axis)[0].where);
    }
  }
  joint.in_parent = calcFrame(body.joint.in_parent, numbers, owner);
  joint.in_body = calcFrame(body.joint.in_body, numbers, owner);
  if (getTraits(body.joint.type).has_pitch) {
    joint.pitch = numbers.calc(body.joint.pitch, {owner, "joint.pitch", "m/rad"});
  }
  return joint;
}

BodyPoint calcBodyPoint(const StationSpec& spec, const SystemNames& names, ModelNumbers& numbers,
                        const std::string& owner) {
  return {names.findBody(spec.body), calcVector(numbers, spec.point, {owner, "point", "m"})};
}

std::vector<std::string> getOutputUnits(const std::vector<OutputSpec>& outputs, const SystemNames& names) {
  std::vector<std::string> units;
  for (const OutputSpec& output : outputs) {
    checkOne(output);
    units.emplace_back(findUnit(output, names));
  }
  return units;
}

OutputNumbers calcOutputNumbers(const OutputSpec& spec, const SystemNames& names, ModelNumbers& numbers) {
  const std::string owner = "output '" + spec.name.text + "'";
  OutputNumbers output = calcQuantity(spec, names, numbers, owner);
  const std::string unit = findUnit(spec, names);
  const bool has_gain = !spec.gain.text.empty(), has_offset = !spec.offset.text.empty();
  if (has_gain || has_offset) {
    output.sensor = {has_gain ? numbers.calc(spec.gain, {owner, "gain", ""}) : 1.0,
                     has_offset ? numbers.calc(spec.offset, {owner, "offset", unit.c_str()}) : 0.0};
  }
  return output;
}

}  // namespace twinmap
