#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/experiment/expression/algebra.hpp"
#include "framework/experiment/model/shape_spec.hpp"

namespace twinmap::robots {

using Vector = algebra::Vec3<double>;
using Matrix = algebra::Mat33<double>;
using Pose = algebra::Transform<double>;

// A robot as its file says it, in SI units. `line`: in the file, from 1.

struct Inertial {
  int line = 0;
  double mass = 0.0;
  Pose frame;     ///< in the link's; its origin is the centre of mass
  Matrix tensor;  ///< about the centre of mass, in `frame`
};

/// What is drawn of a link; without point and orientation, which `frame` is.
struct Visual {
  int line = 0;
  Pose frame;  ///< in the link's
  ShapeSpec shape;
};

struct Link {
  std::string name;
  int line = 0;
  std::optional<Inertial> inertial;
  std::vector<Visual> visuals{};

  bool hasMass() const { return inertial && inertial->mass > 0.0; }
};

enum class JointKind { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar, kBall };

/// Of the coordinate; what the file does not give is empty.
struct Limits {
  int line = 0;
  std::optional<double> lower, upper, effort, velocity;
};

/// coordinate = multiplier * that of `joint` + offset.
struct Mimic {
  int line = 0;
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

struct Joint {
  std::string name;
  int line = 0;
  JointKind kind = JointKind::kFixed;
  std::string parent, child;  ///< links
  Pose frame;                 ///< in the parent link's
  Pose in_child;              ///< the same frame in the child link's, at 0
  Vector axis{1.0, 0.0, 0.0};
  Limits limits;
  double damping = 0.0, friction = 0.0, armature = 0.0;
  double stiffness = 0.0, rest = 0.0;  ///< of a spring
  std::optional<Mimic> mimic;

  bool moves() const { return kind != JointKind::kFixed; }
  /// One coordinate, which forces may act on.
  bool isSingle() const {
    return kind == JointKind::kRevolute || kind == JointKind::kContinuous || kind == JointKind::kPrismatic;
  }
  bool isAngle() const { return kind != JointKind::kPrismatic; }
};

/// A drive of a joint: gear * clamp(gain * clamp(signal) + bias[0] + gear * (bias[1] q + bias[2] q')).
struct Actuator {
  std::string name, joint;
  double gear = 1.0, gain = 1.0;
  std::array<double, 3> bias{};
  std::optional<std::pair<double, double>> signal_range, force_range;
};

/// Frames of two links that are one, or whose origins are.
struct Closure {
  std::string link, other;
  Pose frame, other_frame;
  bool is_weld = false;
};

/// What the file says and the model does not have.
struct LeftOut {
  std::vector<int> lines;
  std::string what;    ///< "<visual>", "limit effort"
  std::string effect;  ///< what it would have done
};

struct Robot {
  std::string file, name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::optional<std::vector<Actuator>> actuators;  ///< none: each joint has a force of its own
  std::optional<Vector> gravity;                   ///< m/s2; none: the file says nothing of it
  std::vector<Closure> closures;
  std::vector<LeftOut> left_out;

  /// Adds a line to what is left out for the same reason.
  void leaveOut(int line, const std::string& what, const std::string& effect);
};

/// Throws ExperimentError "file:line: what".
[[noreturn]] void failAt(const std::string& file, int line, const std::string& what);

}  // namespace twinmap::robots
