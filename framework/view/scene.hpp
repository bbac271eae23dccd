#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
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

struct SceneBody {
  std::string name;
  int parent = 0;  ///< place among the bodies; 0 is the ground
  bool has_mass = true;
  Ellipsoid ellipsoid;
  std::string joint;  ///< its type
  Pose in_parent;     ///< joint frame
  Vector axis;        ///< in it; zero for joints without one
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

struct SceneOutput {
  std::string name, unit;
};

/// One motion of the mechanism: at each time the poses of all bodies, ground first, and the outputs.
struct SceneMotion {
  std::string name;
  std::vector<std::vector<Pose>> poses;
  Eigen::MatrixXd outputs;  ///< outputs x times
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
};

/// The mechanism of an experiment at a point of its parameters (collectSampled), at rest in its initial
/// state where it has no duration. `motion`: what the motion is called. Throws ExperimentError for a model
/// that is wrong, std::runtime_error where the simulation fails.
Scene makeScene(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion);

/// Adds a motion at another point.
void addMotion(const ExperimentSpec& experiment, const Eigen::VectorXd& point, const std::string& motion,
               Scene& scene);

}  // namespace twinmap::view
