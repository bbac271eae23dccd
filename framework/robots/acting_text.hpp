#pragma once

#include <string>
#include <vector>

#include "framework/robots/robot_import.hpp"

namespace twinmap::robots {

/// A drive whose force is measured: an output's name, and the coordinate that it moves.
struct Drive {
  std::string output, coordinate;
};

/// Collects what acts on a robot's joints, what closes its loops, and signals. Adds the parameters of these,
/// and to `robot.left_out` what is not carried over.
class ActingWriter {
 public:
  /// `import` must outlive it.
  explicit ActingWriter(RobotImport& import) : import_(import) {}

  /// Of the body's joint, where it has one coordinate.
  void addJoint(const Body& body);
  /// After all joints.
  void addActuators();
  void addClosures();

  /// Lists of `system`: "  force_laws:\n ..."
  std::string writeLists() const;
  /// Entries of `excitation`.
  const std::string& getSignals() const { return signals_; }
  const std::vector<Drive>& getDrives() const { return drives_; }

 private:
  void addMotion(const Joint& joint, const std::string& q);
  void addLoss(const Joint& joint, const std::string& q, const std::string& unit);
  void addStops(const Joint& joint, const std::string& q);
  void addArmature(const Joint& joint, const std::string& q);
  void addSignal(const std::string& signal, const std::string& unit);
  void addSignal(const std::string& signal, const std::string& called, const std::string& unit,
                 const std::string& otherwise, const std::string& interpolation);
  double requireLimit(const Joint& joint, const char* what, double limit) const;
  double calcOwnInertia(const Joint& joint) const;
  std::string writeLaw(const Actuator& actuator, const std::string& signal);

  RobotImport& import_;
  std::vector<Drive> drives_;
  std::vector<std::string> motions_, forces_, springs_, dampers_, friction_, armature_, stops_, gears_;
  std::string signals_;
};

}  // namespace twinmap::robots
