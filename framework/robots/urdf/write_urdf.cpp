#include "framework/robots/urdf/write_urdf.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/robots/xml/xml_edits.hpp"

namespace twinmap::robots {
namespace {

constexpr const char* kEntries[] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};

std::vector<double> listUrdfEntries(const Matrix& m) {
  return {m.x.x, m.y.x, m.z.x, m.y.y, m.z.y, m.z.z};
}

class UrdfWriter {
 public:
  UrdfWriter(const XmlFile& file, const Robot& robot, const RobotValues& values)
      : file_(file), robot_(robot), values_(values), edits_(file) {}

  std::string write() {
    auto link = robot_.links.begin();
    for (const pugi::xml_node& node : file_.getRoot().children("link")) {
      const auto found = values_.links.find((link++)->name);
      if (found != values_.links.end()) {
        writeInertial(node.child("inertial"), *std::prev(link)->inertial, found->second);
      }
    }
    auto joint = robot_.joints.begin();
    for (const pugi::xml_node& node : file_.getRoot().children("joint")) {
      writeDynamics(node, *joint++);
    }
    return edits_.apply();
  }

 private:
  void writeInertial(const pugi::xml_node& node, const Inertial& old, const MassProperties& mass) {
    edits_.setNumbers(node.child("mass"), "value", {old.mass}, {mass.mass});
    writeCenter(node, old.frame.origin, mass.center);
    const Matrix& turn = old.frame.rotation;
    const std::vector<double> before = listUrdfEntries(old.tensor);
    const std::vector<double> after = listUrdfEntries(algebra::transpose(turn) * mass.tensor * turn);
    constexpr double kRounding =
        1e-12;  // of the largest entry: what spreads and turned axes leave of a tensor
    const double largest = std::max({std::abs(before[0]), std::abs(before[3]), std::abs(before[5])});
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (std::abs(after[i] - before[i]) > kRounding * largest) {
        edits_.setNumbers(node.child("inertia"), kEntries[i], {before[i]}, {after[i]});
      }
    }
  }

  void writeCenter(const pugi::xml_node& node, const Vector& old, const Vector& center) {
    const std::vector<double> before{old.x, old.y, old.z}, after{center.x, center.y, center.z};
    if (node.child("origin")) {
      edits_.setNumbers(node.child("origin"), "xyz", before, after);
    } else if (before != after) {
      edits_.addElement(node, "<origin xyz=\"" + toText(center.x) + " " + toText(center.y) + " " +
                                  toText(center.z) + "\" rpy=\"0 0 0\"/>");
    }
  }

  void writeDynamics(const pugi::xml_node& node, const Joint& joint) {
    const auto find = [&](const std::map<std::string, double>& values, double old) {
      const auto found = values.find(joint.name);
      return found == values.end() ? old : found->second;
    };
    const double damping = find(values_.damping, joint.damping),
                 friction = find(values_.friction, joint.friction);
    if (const pugi::xml_node dynamics = node.child("dynamics")) {
      edits_.setNumbers(dynamics, "damping", {joint.damping}, {damping});
      edits_.setNumbers(dynamics, "friction", {joint.friction}, {friction});
    } else if (damping != 0.0 || friction != 0.0) {
      edits_.addElement(
          node, "<dynamics damping=\"" + toText(damping) + "\" friction=\"" + toText(friction) + "\"/>");
    }
  }

  const XmlFile& file_;
  const Robot& robot_;
  const RobotValues& values_;
  XmlEdits edits_;
};

}  // namespace

std::string writeUrdf(const XmlFile& file, const Robot& robot, const RobotValues& values) {
  return UrdfWriter(file, robot, values).write();
}

}  // namespace twinmap::robots
