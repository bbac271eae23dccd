#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/algebra.hpp"

namespace twinmap::view {

using Vector = algebra::Vec3<double>;
using Pose = algebra::Transform<double>;

/// The ellipsoid of constant density that has a body's mass and inertia, in the body's frame; radii of 0
/// where the mass is in a plane, on a line or in a point. m.
struct Ellipsoid {
  Pose frame;
  Vector radii;
};

/// Triangles on a grid of 65536 steps along each of the frame's axes, from its origin.
struct Mesh {
  std::vector<std::array<std::uint16_t, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What a body looks like.
struct SceneShape {
  std::string kind;  ///< box, cylinder, capsule, sphere, mesh
  Pose frame;        ///< in the body's
  Vector size;       ///< m; edges; of what is round [diameter, diameter, length]; of a mesh its grid's
  Mesh mesh{};
  std::string file{};  ///< of a mesh
};

struct SceneBody {
  std::string name;
  int parent = 0;  ///< place among the bodies; 0 is the ground
  bool has_mass = true;
  Ellipsoid ellipsoid;
  std::string joint;  ///< its type
  Pose in_parent;     ///< joint frame
  Vector axis;        ///< in it; zero for joints without one
  std::vector<SceneShape> shapes{};
  std::vector<std::string> acting{};  ///< kinds of elements on its joint's coordinates: spring, stop, gear
};

/// A line between points of two bodies: a spring, a damper, a rod.
struct SceneLine {
  std::string kind;
  int from = 0, to = 0;
  Vector from_point, to_point;
};

/// A point of a body with a direction: a force, a sensor, a contact.
struct SceneMark {
  std::string kind, name;
  int body = 0;
  Vector point, direction;
};

/// What was measured of an output.
struct SceneMeasured {
  std::vector<double> times, values;
  /// At each time of the scene the rms of measured less updated about it; NaN where nothing was measured.
  std::vector<double> residual;
  std::string scale;  ///< of the residual: "sd" or "% of range"
};

struct SceneOutput {
  std::string name, unit;
  int body = -1;  ///< that it belongs to; -1: none
  std::optional<SceneMeasured> measured{};
};

/// One motion of the mechanism: at each time the poses of all bodies, ground first, and the outputs.
struct SceneMotion {
  std::string name;
  std::vector<std::vector<Pose>> poses;
  Eigen::MatrixXd outputs;        ///< outputs x times; none of what is measured
  Eigen::MatrixXd coordinates{};  ///< coordinates x times
};

/// A small vibration about an equilibrium, at equal steps of one period.
struct SceneMode {
  double frequency = 0.0;      ///< Hz, undamped
  double damping_ratio = 0.0;  ///< below 1
  std::vector<std::vector<Pose>> poses;
};

struct Scene {
  std::string name;
  Vector gravity;                 ///< m/s2
  std::vector<SceneBody> bodies;  ///< ground first; empty for a model from elsewhere
  std::vector<SceneLine> lines;
  std::vector<SceneMark> marks;
  std::vector<SceneOutput> outputs;
  Eigen::VectorXd times;  ///< s
  std::vector<SceneMotion> motions;
  std::vector<SceneMode> modes;
  std::vector<std::string> remarks;  ///< what is drawn otherwise than the experiment says, and why
};

}  // namespace twinmap::view
