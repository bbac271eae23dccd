#include "framework/robots/urdf/read_urdf.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "framework/robots/shape_text.hpp"
#include "framework/robots/urdf/urdf_keys.hpp"

namespace twinmap::robots {
namespace {

struct KindName {
  const char* name;
  JointKind kind;
};
constexpr KindName kKinds[] = {
    {"fixed", JointKind::kFixed},           {"revolute", JointKind::kRevolute},
    {"continuous", JointKind::kContinuous}, {"prismatic", JointKind::kPrismatic},
    {"floating", JointKind::kFloating},     {"planar", JointKind::kPlanar},
};

class UrdfReader {
 public:
  explicit UrdfReader(const XmlFile& file) : file_(file) {}

  Robot read() {
    const pugi::xml_node root = file_.getRoot();
    requireUrdf(root);
    robot_.file = file_.getPath();
    robot_.name = root.attribute("name").value();
    listLeftOut(root, "robot");
    listPackages(root);
    std::set<std::string> names;
    for (const pugi::xml_node& link : root.children("link")) {
      robot_.links.push_back(readLink(link));
      requireNew(names, robot_.links.back().name, link);
    }
    names.clear();
    for (const pugi::xml_node& joint : root.children("joint")) {
      robot_.joints.push_back(readJoint(joint));
      requireNew(names, robot_.joints.back().name, joint);
    }
    if (robot_.links.empty()) {
      file_.fail(root, "has no <link>: a robot has at least one");
    }
    return std::move(robot_);
  }

 private:
  /// An element or value of xacro.
  static bool isMacro(const pugi::xml_node& node) {
    const auto attributes = node.attributes();
    return std::string(node.name()).rfind("xacro:", 0) == 0 ||
           std::any_of(attributes.begin(), attributes.end(), [](const pugi::xml_attribute& attribute) {
             return std::string(attribute.value()).find("${") != std::string::npos;
           });
  }

  void requireUrdf(const pugi::xml_node& root) const {
    const std::string name = root.name();
    if (name != "robot") {
      file_.fail(root, "is not a URDF: its first element must be <robot>");
    }
    const pugi::xml_node macro = root.find_node(isMacro);
    if (macro) {
      file_.fail(macro, "is a macro: expand the file first (xacro robot.urdf.xacro > robot.urdf)");
    }
  }

  /// Every element and attribute that is not carried over, by urdf_keys.
  void listLeftOut(const pugi::xml_node& node, const std::string& path) {
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      const std::string name = attribute.name();
      if (name.rfind("xmlns", 0) != 0) {
        leaveOut(node, path + "@" + name, std::string(node.name()) + " " + name);
      }
    }
    for (const pugi::xml_node& child : node.children()) {
      const std::string child_path = path + "/" + child.name();
      if (child.type() == pugi::node_element &&
          !leaveOut(child, child_path, "<" + std::string(child.name()) + ">")) {
        listLeftOut(child, child_path);
      }
    }
  }

  bool leaveOut(const pugi::xml_node& node, const std::string& path, const std::string& what) {
    const UrdfKey* key = findUrdfKey(path);
    if (key != nullptr && key->effect == nullptr) {
      return false;
    }
    robot_.leaveOut(file_.getLine(node), what,
                    key != nullptr ? key->effect : "is not of URDF: what it does is not known");
    return true;
  }

  void listPackages(const pugi::xml_node& node) {
    for (const pugi::xpath_node& found : node.select_nodes(".//mesh[starts-with(@filename, 'package://')]")) {
      const std::string mesh = found.node().attribute("filename").value();
      if (locateMesh(file_.getPath(), mesh) == mesh) {
        robot_.leaveOut(
            file_.getLine(found.node()), "package://",
            "a mesh in a package of ROS that is not found: to see it, put the package's folder into "
            "ROS_PACKAGE_PATH");
      }
    }
  }

  void requireNew(std::set<std::string>& names, const std::string& name, const pugi::xml_node& node) const {
    if (!names.insert(name).second) {
      file_.fail(node, "'" + name + "' is there twice: give each a name of its own");
    }
  }

  Pose readPose(const pugi::xml_node& parent) const {
    const pugi::xml_node origin = parent.child("origin");
    const Vector rpy = file_.getVector(origin, "rpy", {});
    return {algebra::rotateZ(rpy.z) * algebra::rotateY(rpy.y) * algebra::rotateX(rpy.x),
            file_.getVector(origin, "xyz", {})};
  }

  Link readLink(const pugi::xml_node& node) {
    Link link{file_.getText(node, "name"), file_.getLine(node), std::nullopt};
    for (const pugi::xml_node& visual : node.children("visual")) {
      if (const std::optional<ShapeSpec> shape = readShape(visual.child("geometry"))) {
        link.visuals.push_back({file_.getLine(visual), readPose(visual), *shape});
      } else {
        robot_.leaveOut(file_.getLine(visual), "<visual> without a shape", "a drawing; it moves nothing");
      }
    }
    if (const pugi::xml_node inertial = node.child("inertial")) {
      link.inertial = readInertial(inertial);
    }
    return link;
  }

  /// None where there is no shape that has a size.
  std::optional<ShapeSpec> readShape(const pugi::xml_node& geometry) const {
    ShapeSpec shape;
    const double none = 0.0;
    const auto read = [&](const char* kind, const char* size) {
      return file_.getNumber(geometry.child(kind), size, &none);
    };
    const auto read_round = [&](const char* kind) -> std::optional<RoundShapeSpec> {
      const RoundShapeSpec round{read(kind, "radius"), read(kind, "length")};
      return round.radius > 0.0 && round.length > 0.0 ? std::optional(round) : std::nullopt;
    };
    shape.cylinder = read_round("cylinder");
    shape.capsule = read_round("capsule");
    if (const double radius = read("sphere", "radius"); radius > 0.0) {
      shape.sphere = radius;
    }
    const Vector edges = file_.getVector(geometry.child("box"), "size", {});
    if (edges.x > 0.0 && edges.y > 0.0 && edges.z > 0.0) {
      shape.box = {edges.x, edges.y, edges.z};
    }
    const pugi::xml_node mesh = geometry.child("mesh");
    if (const std::string file = mesh.attribute("filename").value(); !file.empty()) {
      const Vector scale = file_.getVector(mesh, "scale", {1.0, 1.0, 1.0});
      shape.mesh = Name{locateMesh(file_.getPath(), file), {}};
      shape.scale = {scale.x, scale.y, scale.z};
    }
    const int given = (shape.box ? 1 : 0) + (shape.cylinder ? 1 : 0) + (shape.capsule ? 1 : 0) +
                      (shape.sphere ? 1 : 0) + (shape.mesh ? 1 : 0);
    return given == 1 ? std::optional(shape) : std::nullopt;
  }

  Inertial readInertial(const pugi::xml_node& node) const {
    Inertial inertial;
    inertial.line = file_.getLine(node);
    const pugi::xml_node mass = node.child("mass"), tensor = node.child("inertia");
    if (!mass || !tensor) {
      file_.fail(node, "needs <mass> and <inertia>");
    }
    inertial.mass = file_.getNumber(mass, "value");
    inertial.frame = readPose(node);
    const auto get = [&](const char* entry) { return file_.getNumber(tensor, entry); };
    const double xy = get("ixy"), xz = get("ixz"), yz = get("iyz");
    inertial.tensor = {{get("ixx"), xy, xz}, {xy, get("iyy"), yz}, {xz, yz, get("izz")}};
    if (inertial.mass < 0.0) {
      file_.fail(mass, "'value' must not be negative");
    }
    return inertial;
  }

  Joint readJoint(const pugi::xml_node& node) const {
    Joint joint;
    joint.name = file_.getText(node, "name");
    joint.line = file_.getLine(node);
    joint.kind = readKind(node);
    joint.parent = file_.getText(node.child("parent") ? node.child("parent") : node, "link");
    joint.child = file_.getText(node.child("child") ? node.child("child") : node, "link");
    joint.frame = readPose(node);
    joint.axis = file_.getVector(node.child("axis"), "xyz", joint.axis);
    if (joint.moves() && algebra::dot(joint.axis, joint.axis) == 0.0) {
      file_.fail(node.child("axis"), "must not be zero");
    }
    joint.limits = readLimits(node.child("limit"), joint.kind != JointKind::kContinuous);
    const double zero = 0.0;
    joint.damping = file_.getNumber(node.child("dynamics"), "damping", &zero);
    joint.friction = file_.getNumber(node.child("dynamics"), "friction", &zero);
    if (const pugi::xml_node mimic = node.child("mimic")) {
      const double one = 1.0;
      joint.mimic =
          Mimic{file_.getLine(mimic), file_.getText(mimic, "joint"),
                file_.getNumber(mimic, "multiplier", &one), file_.getNumber(mimic, "offset", &zero)};
    }
    return joint;
  }

  JointKind readKind(const pugi::xml_node& node) const {
    const std::string type = file_.getText(node, "type");
    const auto* const found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                           [&](const KindName& kind) { return type == kind.name; });
    if (found == std::end(kKinds)) {
      file_.fail(node,
                 "'type' must be fixed, revolute, continuous, prismatic, floating or planar: '" + type + "'");
    }
    return found->kind;
  }

  Limits readLimits(const pugi::xml_node& node, bool has_ends) const {
    const auto get = [&](const char* name) {
      return node.attribute(name) ? std::optional(file_.getNumber(node, name)) : std::nullopt;
    };
    Limits limits{file_.getLine(node), {}, {}, get("effort"), get("velocity")};
    if (node && has_ends) {
      limits.lower = get("lower").value_or(0.0);
      limits.upper = get("upper").value_or(0.0);
    }
    return limits;
  }

  const XmlFile& file_;
  Robot robot_;
};

}  // namespace

Robot readUrdf(const XmlFile& file) {
  return UrdfReader(file).read();
}

}  // namespace twinmap::robots
