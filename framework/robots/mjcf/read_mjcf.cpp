#include "framework/robots/mjcf/read_mjcf.hpp"

#include <filesystem>
#include <map>

#include "framework/base/json/json.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/base/worker/program_process.hpp"
#include "framework/robots/mjcf/compile_mjcf.hpp"
#include "framework/robots/mjcf/mjcf_keys.hpp"

namespace twinmap::robots {
namespace {

/// What MuJoCo says of the file.
Json compile(const std::string& path) {
  constexpr double kTimeout = 300.0;  // s: meshes whose inertias are integrated
  Json answer;
  try {
    ProgramProcess python({{"python3", "-c", getMjcfCompiler()}, "", {}, 0.0});
    answer = parseJson(
        python.exchange(formatJson(Json{{"file", std::filesystem::absolute(path).string()}}), kTimeout));
  } catch (const WorkerFailure& failure) {
    throw ExperimentError(path + ": python3, which compiles MJCF, failed: " + failure.what());
  }
  if (answer.contains("missing")) {
    throw ExperimentError(path +
                          ": MJCF is compiled by MuJoCo, which this python3 does not have: "
                          "pip install mujoco numpy");
  }
  if (answer.contains("error")) {
    throw ExperimentError(path + ": MuJoCo does not compile it: " + answer["error"].get<std::string>());
  }
  return answer;
}

Vector toVector(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// A rotation is there row by row.
Pose toPose(const Json& json) {
  const Json& r = json.at("rotation");
  const auto column = [&](int i) {
    return Vector{r[i].get<double>(), r[i + 3].get<double>(), r[i + 6].get<double>()};
  };
  return {{column(0), column(1), column(2)}, toVector(json.at("origin"))};
}

std::optional<std::pair<double, double>> toRange(const Json& json, const char* key) {
  if (!json.contains(key)) {
    return std::nullopt;
  }
  return std::pair(json[key].at(0).get<double>(), json[key].at(1).get<double>());
}

class MjcfReader {
 public:
  explicit MjcfReader(const XmlFile& file) : file_(file), json_(compile(file.getPath())) {}

  Robot read() {
    robot_.file = file_.getPath();
    robot_.name = file_.getRoot().attribute("model").value();
    robot_.gravity = toVector(json_.at("gravity"));
    findLines(file_.getRoot());
    const Json& bodies = json_.at("bodies");
    for (const Json& body : bodies) {
      body_names_.push_back(body.at("name").get<std::string>());
    }
    robot_.links.push_back({body_names_.front(), 1, std::nullopt});
    for (std::size_t i = 1; i < bodies.size(); ++i) {
      addBody(bodies[i]);
    }
    addActuators();
    addEqualities();
    if (json_.at("fluid").get<bool>()) {
      robot_.leaveOut(1, "option density, viscosity", "forces of a fluid");
    }
    return std::move(robot_);
  }

 private:
  /// Of named elements, and all that is left out.
  void findLines(const pugi::xml_node& node) {
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() != pugi::node_element || std::string(child.name()) == "default") {
        continue;
      }
      lines_.emplace(std::string(child.name()) + " " + child.attribute("name").value(), file_.getLine(child));
      if (const char* effect = findMjcfEffect(child.name())) {
        robot_.leaveOut(file_.getLine(child), "<" + std::string(child.name()) + ">", effect);
      } else {
        findLines(child);
      }
    }
  }

  int getLine(const std::string& element, const std::string& name) const {
    const auto found = lines_.find(element + " " + name);
    return found == lines_.end() ? 1 : found->second;
  }

  /// A body with k joints is a chain of k links, of which the last has its mass.
  void addBody(const Json& body) {
    const std::string name = body.at("name");
    const int line = getLine("body", name);
    std::string parent = body_names_.at(body.at("parent").get<std::size_t>());
    Pose frame = toPose(body.at("frame"));
    const Json& joints = body.at("joints");
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const bool is_last = i + 1 == joints.size();
      const std::string child = is_last ? name : name + "_" + joints[i].at("name").get<std::string>();
      addJoint(joints[i], parent, child, frame);
      robot_.links.push_back({child, line, is_last ? readInertial(body, line) : std::nullopt});
      parent = child;
      frame = Pose{};
    }
    if (joints.empty()) {
      Joint weld;
      weld.name = name + "_weld";
      weld.line = line;
      weld.parent = parent;
      weld.child = name;
      weld.frame = frame;
      robot_.joints.push_back(weld);
      robot_.links.push_back({name, line, readInertial(body, line)});
    }
    readShapes(body, line, robot_.links.back());
    if (body.at("floats").get<double>() != 0.0) {
      robot_.leaveOut(line, "gravcomp", "a force against gravity: describe it in 'applied_forces'");
    }
  }

  static void readShapes(const Json& body, int line, Link& link) {
    for (const Json& json : body.value("shapes", Json::array())) {
      const std::string kind = json.at("kind");
      const Json& numbers = json.at("numbers");
      ShapeSpec shape;
      if (kind == "mesh") {
        shape.mesh = Name{json.at("file"), {}};
        shape.scale = numbers.get<std::array<double, 3>>();
      } else if (kind == "box") {
        shape.box = numbers.get<std::array<double, 3>>();
      } else if (kind == "sphere") {
        shape.sphere = numbers.at(0).get<double>();
      } else {
        (kind == "cylinder" ? shape.cylinder : shape.capsule) = RoundShapeSpec{numbers.at(0), numbers.at(1)};
      }
      link.visuals.push_back({line, toPose(json.at("frame")), shape});
    }
  }

  static std::optional<Inertial> readInertial(const Json& body, int line) {
    const Vector moments = toVector(body.at("moments"));
    const Matrix tensor{{moments.x, 0.0, 0.0}, {0.0, moments.y, 0.0}, {0.0, 0.0, moments.z}};
    return Inertial{line, body.at("mass"), toPose(body.at("inertial")), tensor};
  }

  /// At its zero a coordinate may have a value: the joint's frame is turned or moved back by it.
  void addJoint(const Json& json, const std::string& parent, const std::string& child, const Pose& frame) {
    const std::string kind = json.at("kind");
    Joint joint;
    joint.name = json.at("name");
    joint.line = getLine("joint", joint.name);
    joint.kind = kind == "hinge"   ? JointKind::kRevolute
                 : kind == "slide" ? JointKind::kPrismatic
                 : kind == "ball"  ? JointKind::kBall
                                   : JointKind::kFloating;
    joint.parent = parent;
    joint.child = child;
    joint.axis = toVector(json.at("axis"));
    const bool flies = joint.kind == JointKind::kFloating;
    joint.in_child.origin = flies ? Vector{} : toVector(json.at("origin"));
    joint.frame = flies ? Pose{} : frame * joint.in_child * calcZero(joint, json.at("zero").get<double>());
    readForces(json, joint);
    robot_.joints.push_back(joint);
  }

  static Pose calcZero(const Joint& joint, double zero) {
    if (joint.kind == JointKind::kRevolute) {
      return {algebra::rotateAbout(joint.axis, -zero), {}};
    }
    return joint.kind == JointKind::kPrismatic
               ? Pose{algebra::makeDiagonal(1.0), algebra::scale(-zero, joint.axis)}
               : Pose{};
  }

  void readForces(const Json& json, Joint& joint) {
    joint.damping = json.at("damping");
    joint.friction = json.at("friction");
    joint.armature = json.at("armature");
    joint.stiffness = json.at("stiffness");
    joint.rest = json.at("rest");
    joint.limits.line = joint.line;
    if (const auto range = toRange(json, "range"); range && joint.isSingle()) {
      joint.limits.lower = range->first;
      joint.limits.upper = range->second;
    }
    const bool has_forces =
        joint.damping != 0.0 || joint.friction != 0.0 || joint.armature != 0.0 || joint.stiffness != 0.0;
    if (!joint.isSingle() && has_forces) {
      robot_.leaveOut(joint.line, "damping, friction, armature, stiffness of joint '" + joint.name + "'",
                      "they act on all of its coordinates: describe them in 'bushings' or 'applied_moments'");
    }
    if (joint.isSingle() && joint.friction != 0.0) {
      robot_.leaveOut(joint.line, "solref of frictionloss", "friction that gives way: here it sticks");
    }
    if (json.at("curved").get<bool>()) {
      robot_.leaveOut(joint.line, "polynomial of joint '" + joint.name + "'",
                      "forces that are not linear: describe them in 'force_laws'");
    }
  }

  void addActuators() {
    robot_.actuators.emplace();
    for (const Json& json : json_.at("actuators")) {
      const std::string name = json.at("name");
      if (!json.at("plain").get<bool>()) {
        robot_.leaveOut(
            findActuatorLine(name), "actuator '" + name + "'",
            "a drive with states, of a tendon, muscle or site: describe it in 'states' and 'force_laws'");
        continue;
      }
      Actuator actuator;
      actuator.name = name;
      actuator.joint = json.at("joint");
      actuator.gear = json.at("gear");
      actuator.gain = json.at("gain");
      actuator.bias = {json.at("bias").at(0), json.at("bias").at(1), json.at("bias").at(2)};
      actuator.signal_range = toRange(json, "control_range");
      actuator.force_range = toRange(json, "force_range");
      robot_.actuators->push_back(actuator);
    }
  }

  int findActuatorLine(const std::string& name) const {
    const pugi::xml_node found =
        file_.getRoot().child("actuator").find_child_by_attribute("name", name.c_str());
    return found ? file_.getLine(found) : 1;
  }

  void addEqualities() {
    const int line = file_.getLine(file_.getRoot().child("equality"));
    for (const Json& json : json_.at("equalities")) {
      const std::string kind = json.at("kind");
      if (!json.at("active").get<bool>() || !json.value("linear", false)) {
        robot_.leaveOut(line, "equality " + kind,
                        "a condition that is off, curved, or of tendons and soft bodies");
        continue;
      }
      robot_.leaveOut(line, "solref of equality", "a condition that gives way: here it holds");
      kind == "joint" ? addMimic(json, line) : addClosure(json, kind == "weld");
    }
  }

  void addMimic(const Json& json, int line) {
    for (Joint& joint : robot_.joints) {
      if (joint.name == json.at("joints").at(0).get<std::string>()) {
        joint.mimic = Mimic{line, json.at("joints").at(1), json.at("ratio"), json.at("offset")};
      }
    }
  }

  void addClosure(const Json& json, bool is_weld) {
    Closure closure;
    closure.link = body_names_.at(json.at("bodies").at(0).get<std::size_t>());
    closure.other = body_names_.at(json.at("bodies").at(1).get<std::size_t>());
    closure.is_weld = is_weld;
    closure.frame.origin = toVector(json.at("points").at(0));
    closure.other_frame.origin = toVector(json.at("points").at(1));
    if (is_weld) {
      const Pose relative = toPose(json.at("frame"));  // of the other in the first
      closure.frame = relative * closure.other_frame;
    }
    robot_.closures.push_back(closure);
  }

  const XmlFile& file_;
  const Json json_;
  Robot robot_;
  std::vector<std::string> body_names_;
  std::map<std::string, int> lines_;
};

}  // namespace

Robot readMjcf(const XmlFile& file) {
  try {
    return MjcfReader(file).read();
  } catch (const Json::exception& error) {
    throw ExperimentError(file.getPath() + ": what MuJoCo made of it cannot be read (" + error.what() +
                          "): update the package mujoco, 4.0 is known to work");
  }
}

}  // namespace twinmap::robots
