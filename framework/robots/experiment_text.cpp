#include "framework/robots/experiment_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/robots/chosen_parameters.hpp"
#include "framework/robots/shape_text.hpp"
#include "framework/robots/yaml_text.hpp"

namespace twinmap::robots {
namespace {

/// Turns z to an axis: a planar joint of an experiment turns about its z.
Matrix turnZ(const Vector& axis) {
  const double length = std::sqrt(algebra::dot(axis, axis));
  const Vector z = algebra::scale(1.0 / length, axis);
  const Vector side = std::abs(z.x) < 0.5 ? Vector{1.0, 0.0, 0.0} : Vector{0.0, 1.0, 0.0};
  Vector x = side - algebra::scale(algebra::dot(side, z), z);
  x = algebra::scale(1.0 / std::sqrt(algebra::dot(x, x)), x);
  return {x, algebra::cross(z, x), z};
}

class ExperimentWriter {
 public:
  ExperimentWriter(Robot& robot, const ImportOptions& options)
      : robot_(robot),
        options_(options),
        chosen_(readChosen(options.parameters)),
        assembly_(assembleBodies(robot, options.base, options.joints)),
        bodies_(assembly_.bodies),
        names_(robot),
        parameters_(names_, options.relative_stddev),
        gravity_(names_.take("g")),
        recording_(options.recording) {}

  std::string write() {
    std::string bodies;
    for (const Body& body : bodies_) {
      bodies += writeBody(body);
      if (body.joint != nullptr && body.joint->isSingle()) {
        addDrive(body);
      }
    }
    if (!options_.from_motion) {
      addActuators();
    } else if (robot_.actuators) {
      robot_.leaveOut(0, "actuators", "--from-motion measures what they exert");
    }
    addClosures();
    noteFrames();
    noteGround(robot_, assembly_);
    const std::string experiment =
        writeParameters() + "system:\n  gravity: " + writeGravity() + "\n  bodies:\n" + bodies +
        writeList("force_laws", forces_) + writeList("springs", springs_) + writeList("dampers", dampers_) +
        writeList("friction", friction_) + writeList("armature", armature_) + writeList("stops", stops_) +
        writeList("constraints", gears_) + writeList("motions", motions_) + writeTail();
    return writeHead() + experiment;
  }

 private:
  std::string writeHead() const {
    std::string text =
        fmt::format("# From {} by twinmap import; lines below are of that file.\n", makeComment(robot_.file));
    text += robot_.left_out.empty() ? "# Everything in it is here.\n" : "# Not carried over:\n";
    for (const std::string& line : describeLeftOut(robot_)) {
      text += "#   " + makeComment(line.substr(robot_.file.size() + 1)) + "\n";
    }
    return text + "name: " + makeIdentifier(robot_.name) + "\n";
  }

  static std::string makeComment(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
  }

  /// Along the file's direction; of its size is the parameter. Without gravity, it is of a planet like Earth,
  /// downwards.
  std::string writeGravity() const {
    if (!robot_.gravity) {
      return "[0, 0, -" + gravity_ + "]";
    }
    const Vector direction = algebra::scale(1.0 / getGravity(), *robot_.gravity);
    const auto write = [&](double share) {
      return share == 0.0 ? "0" : share == -1.0 ? "-" + gravity_ : writeNumber(share) + "*" + gravity_;
    };
    return "[" + write(direction.x) + ", " + write(direction.y) + ", " + write(direction.z) + "]";
  }

  double getGravity() const {
    const double size = robot_.gravity ? std::sqrt(algebra::dot(*robot_.gravity, *robot_.gravity)) : 0.0;
    return size > 0.0 ? size : kGravity;
  }

  std::string writeGravityParameter() const {
    if (robot_.gravity && isZero(*robot_.gravity)) {
      return "";
    }
    const double size = getGravity(), reach = kGravityReach * size / kGravity;
    return fmt::format("  {}: {{bounds: [{}, {}], unit: m/s2, description: {}}}\n", gravity_,
                       toShortText(size - reach, 6), toShortText(size + reach, 6),
                       robot_.gravity ? "gravity" : "gravity is not in a URDF");
  }

  std::string writeParameters() const {
    std::string text = "parameters:\n" + writeGravityParameter();
    if (text == "parameters:\n" && parameters_.getAll().empty()) {
      throw ExperimentError(robot_.file +
                            ": has no gravity, and nothing else to estimate: give --parameters");
    }
    for (const RobotParameter& one : parameters_.getAll()) {
      text +=
          fmt::format("  {}: {{bounds: [{}, {}], ", one.name, writeNumber(one.lower), writeNumber(one.upper));
      text += one.has_prior ? fmt::format("prior: {{normal: {{mean: {}, stddev: {}}}}}, ",
                                          writeNumber(one.value), writeNumber(one.stddev))
                            : "";
      text += "unit: " + one.unit + "}\n";
    }
    return text;
  }

  std::string writeBody(const Body& body) {
    const std::string& name = names_.getBody(body.link->name);
    return fmt::format("    {}:\n", name) + writeMass(body, name) + writeJoint(body) +
           writeShapes(robot_, assembly_, *body.link);
  }

  std::string writeMass(const Body& body, const std::string& name) {
    if (body.massless) {
      return "      mass: 0\n      massless: true\n";
    }
    const MassProperties mass = calcMassProperties(*body.link->inertial);
    const std::string impossible = describeImpossible(mass.tensor);
    if (!impossible.empty()) {
      robot_.leaveOut(body.link->inertial->line, "inertia of link '" + body.link->name + "'",
                      impossible +
                          ": no body has it. It is taken as it is and not checked (unchecked: true); "
                          "correct it by CAD, or measure it");
    }
    const Spread spread = calcSpread(mass);
    const double thinnest = std::min({spread.spread.x, spread.spread.y, spread.spread.z});
    const double widest = std::max({spread.spread.x, spread.spread.y, spread.spread.z});
    if (chosen_.inertia && !body.on_ground && impossible.empty() && thinnest > kThin * widest) {
      return writeChosenMass(name, mass, spread, widest);
    }
    if (chosen_.inertia && !body.on_ground) {
      robot_.leaveOut(body.link->inertial->line, "--parameters inertia of link '" + body.link->name + "'",
                      "its mass is in a plane, on a line or of no body: its numbers stay as they are");
    }
    const Matrix& tensor = mass.tensor;
    return fmt::format(
        "      mass: {}\n      center_of_mass: {}\n      inertia: {{moments: {}, products: {}{}}}\n",
        writeNumber(mass.mass), writeVector(mass.center), writeVector({tensor.x.x, tensor.y.y, tensor.z.z}),
        writeVector({tensor.y.x, tensor.z.x, tensor.z.y}), impossible.empty() ? "" : ", unchecked: true");
  }

  std::string writeChosenMass(const std::string& name, const MassProperties& mass, const Spread& spread,
                              double widest) {
    const auto addThree = [&](const char* const(&suffixes)[3], const Vector& v, bool positive) {
      const auto add = [&](int i, double value) {
        const std::string wish = name + suffixes[i];
        return positive ? parameters_.addPositive(wish, value, "m")
                        : parameters_.add(wish, value, widest, "m");
      };
      const std::string x = add(0, v.x), y = add(1, v.y), z = add(2, v.z);
      return "[" + x + ", " + y + ", " + z + "]";
    };
    std::string text = "      mass: " + parameters_.addPositive(name + "_mass", mass.mass, "kg") + "\n";
    text += "      center_of_mass: " + addThree({"_cx", "_cy", "_cz"}, mass.center, false) + "\n";
    const std::string spreads = addThree({"_lx", "_ly", "_lz"}, spread.spread, true);
    return text + "      inertia: {spread: " + spreads +
           ", skew: " + addThree({"_sxy", "_sxz", "_syz"}, spread.skew, false) + "}\n";
  }

  std::string writeJoint(const Body& body) {
    std::string text = "      joint: {type: ";
    Pose in_parent = body.in_parent, in_body = body.in_body;
    const Joint* joint = body.joint;
    if (joint == nullptr) {
      text += body.is_free_base ? "free" : "weld";
    } else if (joint->isSingle()) {
      text += (joint->isAngle() ? "pin" : "slider") + (", axis: " + writeVector(joint->axis));
    } else if (joint->kind != JointKind::kPlanar) {
      text += joint->kind == JointKind::kBall ? "ball" : "free";
    } else {
      text += "planar";
      const Pose turn{turnZ(joint->axis), {}};
      in_parent = in_parent * turn;
      in_body = in_body * turn;
    }
    text += joint != nullptr ? ", name: " + names_.getJoint(joint->name) : "";
    text += body.parent.empty() ? "" : ", parent: " + names_.getBody(body.parent);
    std::string coordinates;
    for (const std::string& coordinate : names_.takeCoordinates(body)) {
      coordinates += (coordinates.empty() ? "" : ", ") + coordinate;
    }
    text += coordinates.empty() ? "" : ", coordinates: [" + coordinates + "]";
    return text + writeFrame("in_parent", in_parent) + writeFrame("in_body", in_body) + "}\n";
  }

  /// What acts on the coordinate of a joint that turns or slides.
  void addDrive(const Body& body) {
    const Joint& joint = *body.joint;
    const std::string& q = names_.getCoordinate(joint.name);
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
                      names_.getJoint(joint.name), q, names_.getCoordinate(joint.mimic->joint),
                      writeNumber(joint.mimic->multiplier), writeNumber(joint.mimic->offset)));
      return;
    }
    if (options_.from_motion) {
      addMotion(joint, q);
      return;
    }
    if (robot_.actuators) {
      return;
    }
    const std::string signal = names_.take(q + (joint.isAngle() ? "_torque" : "_force"));
    forces_.push_back(fmt::format("{{coordinate: {}, force: {}}}", q, signal));
    addSignal(signal, fmt::format("unit: {}, ", unit));
  }

  /// The coordinate moves as recorded, and what its drive then exerts is measured.
  void addMotion(const Joint& joint, const std::string& q) {
    const std::string signal = names_.take(q + "_motion");
    motions_.push_back(fmt::format("{{coordinate: {}, follows: {}}}", q, signal));
    addSignal(signal, q, fmt::format("unit: {}, ", joint.isAngle() ? "rad" : "m"),
              "sines: [{amplitude: 0, frequency: 1}]", ", interpolation: cubic");
    drives_.push_back({names_.take(q + (joint.isAngle() ? "_torque" : "_force")), q});
  }

  void addLoss(const Joint& joint, const std::string& q, const std::string& unit) {
    const std::string slope = joint.isAngle() ? "N m s/rad" : "N s/m";
    const Limits& limits = joint.limits;
    const double effort = limits.effort.value_or(0.0), speed = limits.velocity.value_or(0.0);
    if (joint.damping != 0.0 || chosen_.damping) {
      const std::string damping =
          !chosen_.damping ? writeNumber(joint.damping)
          : joint.damping > 0.0
              ? parameters_.addPositive(q + "_damping", joint.damping, slope)
              : parameters_.addRange(q + "_damping",
                                     requireLimit(joint, "damping", speed > 0.0 ? effort / speed : 0.0),
                                     slope);
      dampers_.push_back(fmt::format("{{coordinate: {}, damping: {}}}", q, damping));
    }
    if (joint.friction != 0.0 || chosen_.friction) {
      const std::string friction =
          !chosen_.friction ? writeNumber(joint.friction)
          : joint.friction > 0.0
              ? parameters_.addPositive(q + "_friction", joint.friction, unit)
              : parameters_.addRange(q + "_friction", requireLimit(joint, "friction", effort), unit);
      friction_.push_back(fmt::format("{{coordinate: {}, model: coulomb, coulomb: {}}}", q, friction));
    }
  }

  double requireLimit(const Joint& joint, const char* what, double limit) const {
    if (!(limit > 0.0)) {
      failAt(robot_.file, joint.line,
             fmt::format("joint '{}' has no {}, and no limits (effort, velocity) that say how large it "
                         "may be: give <dynamics {}=\"...\"/>, or leave {} out of --parameters",
                         joint.name, what, what, what));
    }
    return limit;
  }

  void addStops(const Joint& joint, const std::string& q) {
    const Limits& limits = joint.limits;
    if (!limits.lower) {
      return;
    }
    if (!options_.stops) {
      robot_.leaveOut(limits.line, "limit lower, upper",
                      "where the joint ends: --stops makes rigid stops of them");
      return;
    }
    stops_.push_back(
        fmt::format("{{coordinate: {}, below: {}, restitution: 0}}", q, writeNumber(*limits.lower)));
    stops_.push_back(
        fmt::format("{{coordinate: {}, above: {}, restitution: 0}}", q, writeNumber(*limits.upper)));
  }

  /// Where the file says nothing of the rotor: up to as much as the joint's own link has about its axis.
  void addArmature(const Joint& joint, const std::string& q) {
    if (joint.armature == 0.0 && !chosen_.armature) {
      return;
    }
    const char* unit = joint.isAngle() ? "kg m2" : "kg";
    const std::string inertia = !chosen_.armature ? writeNumber(joint.armature)
                                : joint.armature > 0.0
                                    ? parameters_.addPositive(q + "_armature", joint.armature, unit)
                                    : parameters_.addRange(q + "_armature", calcOwnInertia(joint), unit);
    armature_.push_back(fmt::format("{{coordinate: {}, inertia: {}}}", q, inertia));
  }

  double calcOwnInertia(const Joint& joint) const {
    const Body& body =
        *std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& one) { return one.joint == &joint; });
    if (body.massless) {
      failAt(robot_.file, joint.line,
             "joint '" + joint.name + "' moves a link without mass: leave armature out of --parameters");
    }
    const MassProperties mass = calcMassProperties(*body.link->inertial);
    const Vector axis = body.in_body.rotation *
                        algebra::scale(1.0 / std::sqrt(algebra::dot(joint.axis, joint.axis)), joint.axis);
    const Vector arm = algebra::cross(axis, mass.center - body.in_body.origin);
    return joint.isAngle() ? algebra::dot(axis, mass.tensor * axis) + mass.mass * algebra::dot(arm, arm)
                           : mass.mass;
  }

  void addActuators() {
    for (const Actuator& actuator : robot_.actuators.value_or(std::vector<Actuator>{})) {
      const auto body = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& one) {
        return one.joint != nullptr && one.joint->name == actuator.joint;
      });
      if (body != bodies_.end()) {
        forces_.push_back(fmt::format("{{coordinate: {}, force: '{}'}}", names_.getCoordinate(actuator.joint),
                                      writeLaw(actuator, names_.take(actuator.name))));
      }
    }
  }

  /// A force, as recorded, else 0.
  void addSignal(const std::string& signal, const std::string& unit) {
    addSignal(signal, signal, unit, "pulses: [{amplitude: 0, start: 0, end: 1}]", "");
  }

  void addSignal(const std::string& signal, const std::string& called, const std::string& unit,
                 const std::string& otherwise, const std::string& interpolation) {
    const std::string* column = recording_ ? recording_->take(called) : nullptr;
    const std::string terms =
        column != nullptr
            ? fmt::format("tables: [{{measured: {{file: {}, column: {}, time: {}, start: {}}}{}}}]",
                          quote(recording_->file), quote(*column), quote(recording_->time),
                          writeNumber(recording_->first), interpolation)
            : otherwise;
    signals_ += fmt::format("  {}: {{{}{}}}\n", signal, unit, terms);
  }

  std::string writeLaw(const Actuator& actuator, const std::string& signal) {
    addSignal(signal, "");
    const auto clamp = [](const std::string& text, const std::optional<std::pair<double, double>>& range) {
      return range ? fmt::format("clamp({}, {}, {})", text, writeNumber(range->first),
                                 writeNumber(range->second))
                   : text;
    };
    const std::string& q = names_.getCoordinate(actuator.joint);
    std::string law = writeNumber(actuator.gain) + "*" + clamp(signal, actuator.signal_range);
    const double by_state = actuator.gear;
    for (const auto& [factor, what] :
         {std::pair{actuator.bias[0], std::string()}, std::pair{by_state * actuator.bias[1], "*" + q},
          std::pair{by_state * actuator.bias[2], "*" + q + "_dot"}}) {
      law += factor != 0.0 ? " + (" + writeNumber(factor) + ")" + what : "";
    }
    return writeNumber(actuator.gear) + "*" + clamp("(" + law + ")", actuator.force_range);
  }

  void addClosures() {
    for (const Closure& closure : robot_.closures) {
      const Place &from = assembly_.places.at(closure.link), &to = assembly_.places.at(closure.other);
      const auto write = [&](const Place& place, const Pose& frame) {
        const Pose in_body = place.frame * frame;
        const std::string body = place.body != nullptr ? names_.getBody(place.body->name) : "ground";
        return "{body: " + body +
               (closure.is_weld ? writeFrame("frame", in_body) : ", point: " + writeVector(in_body.origin)) +
               "}";
      };
      gears_.push_back(fmt::format("{{{}: {{from: {}, to: {}}}}}", closure.is_weld ? "weld" : "coincident",
                                   write(from, closure.frame), write(to, closure.other_frame)));
    }
  }

  bool isBody(const Link& link) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) { return body.link == &link; });
  }

  /// Links that are not bodies.
  void noteFrames() {
    for (const Link& link : robot_.links) {
      if (link.inertial && !link.hasMass()) {
        const Matrix& t = link.inertial->tensor;
        const bool has_tensor = !isZero(t.x) || !isZero(t.y) || !isZero(t.z);
        if (has_tensor) {
          robot_.leaveOut(link.inertial->line, "<inertia> of a link without mass",
                          "no body has it: give the link a mass");
        }
      }
      if (!link.hasMass() && !robot_.gravity && !isBody(link)) {
        robot_.leaveOut(link.line, "<link> without mass", "a frame of the link that it is fixed to: no body");
      }
    }
  }

  static std::string writeList(const char* key, const std::vector<std::string>& items) {
    std::string text = items.empty() ? "" : fmt::format("  {}:\n", key);
    for (const std::string& item : items) {
      text += "    - " + item + "\n";
    }
    return text;
  }

  std::string writeTail() {
    std::string outputs, columns, noise;
    std::vector<std::string> all, recorded;
    for (const auto& [name, quantity] : listOutputs()) {
      outputs += fmt::format("  {}: {{{}}}\n", name, quantity);
      noise += (noise.empty() ? "" : ", ") + name + ": unknown";
      all.push_back(name);
      if (const std::string* column = recording_ ? recording_->take(name) : nullptr) {
        columns += (columns.empty() ? "" : ", ") + name + ": " + quote(*column);
        recorded.push_back(name);
      }
    }
    if (all.empty()) {
      throw ExperimentError(robot_.file + ": has no joint that moves: try --base free");
    }
    return (signals_.empty() ? "" : "excitation:\n" + signals_) + "outputs:\n" + outputs +
           writeSamples(recording_ ? recorded : all) + "noise: {stddev: {" + noise + "}}\n" +
           writeMeasurement(columns);
  }

  /// A motion is prescribed of a joint with one coordinate.
  void requireSingle(const Body& body) const {
    if (body.joint == nullptr || !body.joint->isSingle()) {
      failAt(
          robot_.file, body.joint != nullptr ? body.joint->line : body.link->line,
          "link '" + body.link->name +
              "' flies, turns as a ball or moves in a plane: --from-motion knows joints that turn or slide "
              "alone. Simulate the motion from the forces: leave --from-motion out");
    }
  }

  /// Names, and what is measured: how the robot moves, or what its drives exert.
  std::vector<std::pair<std::string, std::string>> listOutputs() {
    std::vector<std::pair<std::string, std::string>> outputs;
    for (const Drive& drive : drives_) {
      outputs.emplace_back(drive.output, "force_of: " + drive.coordinate);
    }
    for (const Body& body : bodies_) {
      for (const std::string& q : names_.takeCoordinates(body)) {
        if (options_.from_motion) {
          requireSingle(body);
        } else {
          outputs.emplace_back(q, "coordinate: " + q);
        }
      }
    }
    return outputs;
  }

  std::string writeSamples(const std::vector<std::string>& outputs) const {
    if (outputs.empty()) {
      throw ExperimentError(recording_->file + ": no column is called as a joint of " + robot_.file);
    }
    const double interval = recording_ ? recording_->interval : kInterval;
    const int count = recording_ ? recording_->count : kCount;
    return fmt::format(
        "simulation: {{duration: {}}}\nfeatures:\n  - samples: {{outputs: [{}], start: 0, interval: {}, "
        "count: {}}}\n",
        toShortText(interval * (count - 1), 12), fmt::join(outputs, ", "), toShortText(interval, 12), count);
  }

  std::string writeMeasurement(const std::string& columns) {
    if (!recording_) {
      return "";
    }
    for (const std::string& unused : recording_->listUnused()) {
      robot_.leaveOut(
          0, "column '" + unused + "' of " + recording_->file,
          "it is called as no coordinate, and as no signal: say in 'measurement' or 'excitation' what it is");
    }
    return fmt::format("measurement:\n  time: {}\n  start: {}\n  columns: {{{}}}\n", quote(recording_->time),
                       writeNumber(recording_->first), columns);
  }

  static constexpr double kInterval = 0.01;  ///< s
  static constexpr int kCount = 101;
  static constexpr double kGravity = 9.81;       ///< m/s2
  static constexpr double kGravityReach = 0.03;  ///< m/s2; at sea level it is 9.780 to 9.832 (WGS 84)
  static constexpr double kThin = 1e-4;  ///< of the widest spread: below it a prior of 20 % says nothing

  Robot& robot_;
  const ImportOptions& options_;
  Chosen chosen_;
  Assembly assembly_;
  const std::vector<Body>& bodies_;
  RobotNames names_;
  ChosenParameters parameters_;
  std::string gravity_;
  std::optional<Recording> recording_;
  struct Drive {
    std::string output, coordinate;
  };
  std::vector<Drive> drives_;  ///< whose forces are measured
  std::vector<std::string> motions_, forces_, springs_, dampers_, friction_, armature_, stops_, gears_;
  std::string signals_;
};

}  // namespace

std::string makeExperimentText(Robot& robot, const ImportOptions& options) {
  return ExperimentWriter(robot, options).write();
}

std::vector<std::string> describeLeftOut(const Robot& robot) {
  std::vector<std::string> texts;
  for (const LeftOut& one : robot.left_out) {
    std::string lines;
    for (const int line : one.lines) {
      lines += (lines.empty() ? "" : ", ") + (line > 0 ? std::to_string(line) : "-");
    }
    texts.push_back(robot.file + ":" + lines + ": " + one.what + ": " + one.effect);
  }
  return texts;
}

}  // namespace twinmap::robots
