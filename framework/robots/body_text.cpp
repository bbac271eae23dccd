#include "framework/robots/body_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

class BodyWriter {
 public:
  explicit BodyWriter(RobotImport& import) : import_(import) {}

  std::string write(const Body& body) {
    const std::string& name = import_.names.getBody(body.link->name);
    return fmt::format("    {}:\n", name) + writeMass(body, name) + writeJoint(body) +
           writeShapes(import_.robot, import_.assembly, *body.link);
  }

 private:
  std::string writeMass(const Body& body, const std::string& name) {
    if (body.massless) {
      return "      mass: 0\n      massless: true\n";
    }
    const MassProperties mass = calcMassProperties(*body.link->inertial);
    const std::string impossible = describeImpossible(mass.tensor);
    if (!impossible.empty()) {
      import_.robot.leaveOut(body.link->inertial->line, "inertia of link '" + body.link->name + "'",
                             impossible +
                                 ": no body has it. It is taken as it is and not checked (unchecked: true); "
                                 "correct it by CAD, or measure it");
    }
    const Spread spread = calcSpread(mass);
    const double thinnest = std::min({spread.spread.x, spread.spread.y, spread.spread.z});
    const double widest = std::max({spread.spread.x, spread.spread.y, spread.spread.z});
    if (import_.chosen.inertia && !body.on_ground && impossible.empty() && thinnest > kThin * widest) {
      return writeChosenMass(name, mass, spread, widest);
    }
    if (import_.chosen.inertia && !body.on_ground) {
      import_.robot.leaveOut(body.link->inertial->line,
                             "--parameters inertia of link '" + body.link->name + "'",
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
        return positive ? import_.parameters.addPositive(wish, value, "m")
                        : import_.parameters.add(wish, value, widest, "m");
      };
      const std::string x = add(0, v.x), y = add(1, v.y), z = add(2, v.z);
      return "[" + x + ", " + y + ", " + z + "]";
    };
    std::string text =
        "      mass: " + import_.parameters.addPositive(name + "_mass", mass.mass, "kg") + "\n";
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
    text += joint != nullptr ? ", name: " + import_.names.getJoint(joint->name) : "";
    text += body.parent.empty() ? "" : ", parent: " + import_.names.getBody(body.parent);
    std::string coordinates;
    for (const std::string& coordinate : import_.names.takeCoordinates(body)) {
      coordinates += (coordinates.empty() ? "" : ", ") + coordinate;
    }
    text += coordinates.empty() ? "" : ", coordinates: [" + coordinates + "]";
    return text + writeFrame("in_parent", in_parent) + writeFrame("in_body", in_body) + "}\n";
  }

  static constexpr double kThin = 1e-4;  ///< of the widest spread: below it a prior of 20 % says nothing

  RobotImport& import_;
};

}  // namespace

std::string writeBody(RobotImport& import, const Body& body) {
  return BodyWriter(import).write(body);
}

}  // namespace twinmap::robots
