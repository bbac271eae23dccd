#include "framework/robots/mjcf/write_mjcf.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/robots/xml/xml_edits.hpp"

namespace twinmap::robots {
namespace {

/// As MuJoCo's fullinertia has them.
std::vector<double> listFullInertia(const Matrix& m) {
  return {m.x.x, m.y.y, m.z.z, m.y.x, m.z.x, m.z.y};
}

std::vector<double> list(const Vector& v) {
  return {v.x, v.y, v.z};
}

class MjcfWriter {
 public:
  MjcfWriter(const XmlFile& file, const Robot& robot, const RobotValues& values)
      : file_(file), robot_(robot), values_(values), edits_(file) {}

  std::string write() {
    for (const Link& link : robot_.links) {
      const auto found = values_.links.find(link.name);
      if (found != values_.links.end()) {
        writeInertial(find("body", link.name), calcMassProperties(*link.inertial), found->second);
      }
    }
    for (const Joint& joint : robot_.joints) {
      writeNumber(joint, "damping", joint.damping, values_.damping);
      writeNumber(joint, "frictionloss", joint.friction, values_.friction);
      writeNumber(joint, "armature", joint.armature, values_.armature);
    }
    return edits_.apply();
  }

 private:
  pugi::xml_node find(const std::string& element, const std::string& name) const {
    const pugi::xml_node found = file_.getRoot().find_node([&](const pugi::xml_node& node) {
      return node.name() == element && node.attribute("name").value() == name;
    });
    if (!found) {
      failAt(file_.getPath(), 1,
             "has no <" + element + " name=\"" + name +
                 "\">: give it this name, or write the included file that has it into this one");
    }
    return found;
  }

  void writeInertial(const pugi::xml_node& body, const MassProperties& old, const MassProperties& mass) {
    const pugi::xml_node inertial = body.child("inertial");
    if (!inertial) {
      requireOwnInertia();
      edits_.addElement(body, "<inertial pos=\"" + joinNumbers(list(mass.center)) + "\" mass=\"" +
                                  toText(mass.mass) + "\" fullinertia=\"" +
                                  joinNumbers(listFullInertia(mass.tensor)) + "\"/>");
      return;
    }
    edits_.setNumbers(inertial, "mass", {old.mass}, {mass.mass});
    edits_.setNumbers(inertial, "pos", list(old.center), list(mass.center));
    writeTensor(inertial, listFullInertia(old.tensor), listFullInertia(mass.tensor));
  }

  /// In the body's axes, so that whatever turns those of the file goes.
  void writeTensor(const pugi::xml_node& inertial, const std::vector<double>& old,
                   const std::vector<double>& tensor) {
    constexpr double kRounding =
        1e-12;  // of the largest entry: what spreads and turned axes leave of a tensor
    const double largest = *std::max_element(old.begin(), old.end());
    const bool same = std::equal(old.begin(), old.end(), tensor.begin(),
                                 [&](double a, double b) { return std::abs(a - b) <= kRounding * largest; });
    if (same) {
      return;
    }
    if (inertial.attribute("fullinertia")) {
      edits_.setNumbers(inertial, "fullinertia", old, tensor);
      return;
    }
    for (const char* turned : {"quat", "axisangle", "xyaxes", "zaxis", "euler", "diaginertia"}) {
      edits_.removeAttribute(inertial, turned);
    }
    edits_.setNumbers(inertial, "fullinertia", {}, tensor);
  }

  void requireOwnInertia() const {
    const pugi::xml_node compiler = file_.getRoot().child("compiler");
    if (std::string(compiler.attribute("inertiafromgeom").value()) == "true") {
      file_.fail(compiler,
                 "takes all inertias from geoms: set inertiafromgeom=\"auto\" to write estimated ones");
    }
  }

  void writeNumber(const Joint& joint, const char* attribute, double old,
                   const std::map<std::string, double>& values) {
    const auto found = values.find(joint.name);
    if (found != values.end()) {
      edits_.setNumbers(find("joint", joint.name), attribute, {old}, {found->second});
    }
  }

  const XmlFile& file_;
  const Robot& robot_;
  const RobotValues& values_;
  XmlEdits edits_;
};

}  // namespace

std::string writeMjcf(const XmlFile& file, const Robot& robot, const RobotValues& values) {
  return MjcfWriter(file, robot, values).write();
}

}  // namespace twinmap::robots
