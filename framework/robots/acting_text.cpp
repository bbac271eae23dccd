#include "framework/robots/acting_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/source_location.hpp"
#include "framework/robots/yaml_text.hpp"

namespace twinmap::robots {
namespace {

std::string writeList(const char* key, const std::vector<std::string>& items) {
  std::string text = items.empty() ? "" : fmt::format("  {}:\n", key);
  for (const std::string& item : items) {
    text += "    - " + item + "\n";
  }
  return text;
}

}  // namespace

/// What acts on the coordinate of a joint that turns or slides.
void ActingWriter::addJoint(const Body& body) {
  if (body.joint == nullptr || !body.joint->isSingle()) {
    return;
  }
  const Joint& joint = *body.joint;
  const std::string& q = import_.names.getCoordinate(joint.name);
  const char* unit = joint.isAngle() ? "N m" : "N";
  addLoss(joint, q, unit);
  addStops(joint, q);
  addArmature(joint, q);
  if (joint.stiffness != 0.0) {
    springs_.push_back(fmt::format("{{coordinate: {}, stiffness: {}, rest: {}}}", q,
                                   writeNumber(joint.stiffness), writeNumber(joint.rest)));
  }
  if (joint.mimic) {
    gears_.push_back(
        fmt::format("{{name: {}_mimic, gear: {{coordinate: {}, driver: {}, ratio: {}, offset: {}}}}}",
                    import_.names.getJoint(joint.name), q, import_.names.getCoordinate(joint.mimic->joint),
                    writeNumber(joint.mimic->multiplier), writeNumber(joint.mimic->offset)));
    return;
  }
  if (import_.options.from_motion) {
    addMotion(joint, q);
    return;
  }
  if (import_.robot.actuators) {
    return;
  }
  const std::string signal = import_.names.take(q + (joint.isAngle() ? "_torque" : "_force"));
  forces_.push_back(fmt::format("{{coordinate: {}, force: {}}}", q, signal));
  addSignal(signal, fmt::format("unit: {}, ", unit));
}

/// The coordinate moves as recorded, and what its drive then exerts is measured.
void ActingWriter::addMotion(const Joint& joint, const std::string& q) {
  const std::string signal = import_.names.take(q + "_motion");
  motions_.push_back(fmt::format("{{coordinate: {}, follows: {}}}", q, signal));
  addSignal(signal, q, fmt::format("unit: {}, ", joint.isAngle() ? "rad" : "m"),
            "sines: [{amplitude: 0, frequency: 1}]", ", interpolation: cubic");
  drives_.push_back({import_.names.take(q + (joint.isAngle() ? "_torque" : "_force")), q});
}

void ActingWriter::addLoss(const Joint& joint, const std::string& q, const std::string& unit) {
  const std::string slope = joint.isAngle() ? "N m s/rad" : "N s/m";
  const Limits& limits = joint.limits;
  const double effort = limits.effort.value_or(0.0), speed = limits.velocity.value_or(0.0);
  if (joint.damping != 0.0 || import_.chosen.damping) {
    const std::string damping =
        !import_.chosen.damping ? writeNumber(joint.damping)
        : joint.damping > 0.0
            ? import_.parameters.addPositive(q + "_damping", joint.damping, slope)
            : import_.parameters.addRange(
                  q + "_damping", requireLimit(joint, "damping", speed > 0.0 ? effort / speed : 0.0), slope);
    dampers_.push_back(fmt::format("{{coordinate: {}, damping: {}}}", q, damping));
  }
  if (joint.friction != 0.0 || import_.chosen.friction) {
    const std::string friction =
        !import_.chosen.friction ? writeNumber(joint.friction)
        : joint.friction > 0.0
            ? import_.parameters.addPositive(q + "_friction", joint.friction, unit)
            : import_.parameters.addRange(q + "_friction", requireLimit(joint, "friction", effort), unit);
    friction_.push_back(fmt::format("{{coordinate: {}, model: coulomb, coulomb: {}}}", q, friction));
  }
}

double ActingWriter::requireLimit(const Joint& joint, const char* what, double limit) const {
  if (!(limit > 0.0)) {
    failAt(import_.robot.file, joint.line,
           fmt::format("joint '{}' has no {}, and no limits (effort, velocity) that say how large it "
                       "may be: give <dynamics {}=\"...\"/>, or leave {} out of --parameters",
                       joint.name, what, what, what));
  }
  return limit;
}

void ActingWriter::addStops(const Joint& joint, const std::string& q) {
  const Limits& limits = joint.limits;
  if (!limits.lower) {
    return;
  }
  if (!import_.options.stops) {
    import_.robot.leaveOut(limits.line, "limit lower, upper",
                           "where the joint ends: --stops makes rigid stops of them");
    return;
  }
  stops_.push_back(
      fmt::format("{{coordinate: {}, below: {}, restitution: 0}}", q, writeNumber(*limits.lower)));
  stops_.push_back(
      fmt::format("{{coordinate: {}, above: {}, restitution: 0}}", q, writeNumber(*limits.upper)));
}

/// Where the file says nothing of the rotor: up to as much as the joint's own link has about its axis.
void ActingWriter::addArmature(const Joint& joint, const std::string& q) {
  if (joint.armature == 0.0 && !import_.chosen.armature) {
    return;
  }
  const char* unit = joint.isAngle() ? "kg m2" : "kg";
  const std::string inertia = !import_.chosen.armature ? writeNumber(joint.armature)
                              : joint.armature > 0.0
                                  ? import_.parameters.addPositive(q + "_armature", joint.armature, unit)
                                  : import_.parameters.addRange(q + "_armature", calcOwnInertia(joint), unit);
  armature_.push_back(fmt::format("{{coordinate: {}, inertia: {}}}", q, inertia));
}

double ActingWriter::calcOwnInertia(const Joint& joint) const {
  const Body& body = *std::find_if(import_.assembly.bodies.begin(), import_.assembly.bodies.end(),
                                   [&](const Body& one) { return one.joint == &joint; });
  if (body.massless) {
    failAt(import_.robot.file, joint.line,
           "joint '" + joint.name + "' moves a link without mass: leave armature out of --parameters");
  }
  const MassProperties mass = calcMassProperties(*body.link->inertial);
  const Vector axis = body.in_body.rotation *
                      algebra::scale(1.0 / std::sqrt(algebra::dot(joint.axis, joint.axis)), joint.axis);
  const Vector arm = algebra::cross(axis, mass.center - body.in_body.origin);
  return joint.isAngle() ? algebra::dot(axis, mass.tensor * axis) + mass.mass * algebra::dot(arm, arm)
                         : mass.mass;
}

/// A force, as recorded, else 0.
void ActingWriter::addSignal(const std::string& signal, const std::string& unit) {
  addSignal(signal, signal, unit, "pulses: [{amplitude: 0, start: 0, end: 1}]", "");
}

void ActingWriter::addSignal(const std::string& signal, const std::string& called, const std::string& unit,
                             const std::string& otherwise, const std::string& interpolation) {
  const std::string* column = import_.recording ? import_.recording->take(called) : nullptr;
  const std::string terms =
      column != nullptr
          ? fmt::format("tables: [{{measured: {{file: {}, column: {}, time: {}, start: {}}}{}}}]",
                        quote(import_.recording->file), quote(*column), quote(import_.recording->time),
                        writeNumber(import_.recording->first), interpolation)
          : otherwise;
  signals_ += fmt::format("  {}: {{{}{}}}\n", signal, unit, terms);
}

std::string ActingWriter::writeLaw(const Actuator& actuator, const std::string& signal) {
  addSignal(signal, "");
  const auto clamp = [](const std::string& text, const std::optional<std::pair<double, double>>& range) {
    return range
               ? fmt::format("clamp({}, {}, {})", text, writeNumber(range->first), writeNumber(range->second))
               : text;
  };
  const std::string& q = import_.names.getCoordinate(actuator.joint);
  std::string law = writeNumber(actuator.gain) + "*" + clamp(signal, actuator.signal_range);
  const double by_state = actuator.gear;
  for (const auto& [factor, what] :
       {std::pair{actuator.bias[0], std::string()}, std::pair{by_state * actuator.bias[1], "*" + q},
        std::pair{by_state * actuator.bias[2], "*" + q + "_dot"}}) {
    law += factor != 0.0 ? " + (" + writeNumber(factor) + ")" + what : "";
  }
  return writeNumber(actuator.gear) + "*" + clamp("(" + law + ")", actuator.force_range);
}

void ActingWriter::addActuators() {
  if (import_.options.from_motion) {
    if (import_.robot.actuators) {
      import_.robot.leaveOut(0, "actuators", "--from-motion measures what they exert");
    }
    return;
  }
  for (const Actuator& actuator : import_.robot.actuators.value_or(std::vector<Actuator>{})) {
    const auto body = std::find_if(
        import_.assembly.bodies.begin(), import_.assembly.bodies.end(),
        [&](const Body& one) { return one.joint != nullptr && one.joint->name == actuator.joint; });
    if (body != import_.assembly.bodies.end()) {
      forces_.push_back(fmt::format("{{coordinate: {}, force: '{}'}}",
                                    import_.names.getCoordinate(actuator.joint),
                                    writeLaw(actuator, import_.names.take(actuator.name))));
    }
  }
}

void ActingWriter::addClosures() {
  for (const Closure& closure : import_.robot.closures) {
    const Place &from = import_.assembly.places.at(closure.link),
                &to = import_.assembly.places.at(closure.other);
    const auto write = [&](const Place& place, const Pose& frame) {
      const Pose in_body = place.frame * frame;
      const std::string body = place.body != nullptr ? import_.names.getBody(place.body->name) : "ground";
      return "{body: " + body +
             (closure.is_weld ? writeFrame("frame", in_body) : ", point: " + writeVector(in_body.origin)) +
             "}";
    };
    gears_.push_back(fmt::format("{{{}: {{from: {}, to: {}}}}}", closure.is_weld ? "weld" : "coincident",
                                 write(from, closure.frame), write(to, closure.other_frame)));
  }
}

std::string ActingWriter::writeLists() const {
  return writeList("force_laws", forces_) + writeList("springs", springs_) + writeList("dampers", dampers_) +
         writeList("friction", friction_) + writeList("armature", armature_) + writeList("stops", stops_) +
         writeList("constraints", gears_) + writeList("motions", motions_);
}

}  // namespace twinmap::robots
