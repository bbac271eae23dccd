#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/named_forces.hpp"
#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

/// Where a coordinate lives: `local` counts within its joint.
struct CoordinatePlace {
  int body;  ///< 1-based; 0 is the ground
  int local;
  JointCoordinate traits;
};

/// The bodies, coordinates and states of first order of a system by name. All lookups throw ExperimentError,
/// with the nearest name, for a name that does not exist.
class SystemNames {
 public:
  /// Throws ExperimentError for a name that is declared twice, a parent that is not declared before, and a
  /// joint with a wrong number of coordinates or an axis it does not have.
  explicit SystemNames(const SystemSpec& system);

  /// 0 for "ground", else the body's place in the file, counted from 1 (Simbody's mobilized body index).
  int findBody(const Name& name) const;
  /// The coordinate's place in getCoordinateNames().
  int findCoordinate(const Name& name) const;
  /// The same, for one that takes forces; else ExperimentError.
  int findForcedCoordinate(const Name& name) const;

  /// Whether the coordinate moves as a signal says.
  bool isPrescribed(int coordinate) const { return is_prescribed_[static_cast<std::size_t>(coordinate)]; }

  /// The body of a joint, which is called by its own name or that of its body.
  int findJoint(const Name& name) const;
  /// A force element, constraint or prescribed motion by its name.
  const NamedForce& findForce(const Name& name) const;

  const std::vector<std::string>& getCoordinateNames() const { return coordinate_names_; }
  const std::vector<CoordinatePlace>& getCoordinates() const { return coordinates_; }
  /// The system's states, then those of its elements in the order of forEachType; those that the file does
  /// not name by what no expression can use: "state 2 (on 'x')".
  const std::vector<std::string>& getStateNames() const { return state_names_; }

 private:
  void addBody(const BodySpec& body);
  void addStates(const SystemSpec& system);
  void addCoordinates(const JointSpec& joint, int body);

  std::vector<std::string> body_names_{"ground"}, joint_names_{"ground"};
  std::vector<NamedForce> forces_;
  std::vector<std::string> coordinate_names_, state_names_;
  std::vector<CoordinatePlace> coordinates_;
  std::vector<bool> is_prescribed_;
};

}  // namespace twinmap
