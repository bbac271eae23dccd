#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/experiment/model/output_spec.hpp"
#include "framework/models/mechanism/system_names.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

// The numbers of a system's parts for one parameter set, in SI units, checked to be those of a real system.
// All throw SimulationFailure for numbers that are not finite, and ExperimentError for unknown names.

struct MassNumbers {
  double mass;                                ///< positive
  Eigen::Vector3d center, moments, products;  ///< the inertia about the centre of mass, in the body's axes
};

/// A frame fixed to a body: its origin, and body-fixed x-y-z angles.
struct FrameNumbers {
  Eigen::Vector3d point, angles;
};

struct JointNumbers {
  std::optional<Eigen::Vector3d> axis;  ///< of any length but 0
  FrameNumbers in_parent, in_body;
  double pitch = 0.0;  ///< of a screw, m/rad
};

/// A point fixed to a body, in its frame.
struct BodyPoint {
  int body;
  Eigen::Vector3d point;
};

enum class OutputKind {
  kCoordinate,
  kSpeed,
  kPosition,
  kVelocity,
  kAcceleration,
  kSpecificForce,
  kAngularVelocity,
  kReaction,
  kForce,
  kExpression
};

struct OutputNumbers {
  struct Sensor {
    double gain, offset;  ///< the offset in the output's unit
  };
  OutputKind kind;
  int coordinate;             ///< of kCoordinate and kSpeed, else -1
  BodyPoint station;          ///< of the others; of a reaction the child body
  Eigen::Vector3d direction;  ///< a unit vector, in ground axes or the body's
  const Expression* expression = nullptr;
  std::optional<Sensor> sensor;
  std::optional<ForceComponent> component{};  ///< of kReaction and kForce
  const NamedForce* force = nullptr;          ///< of kForce
};

Eigen::Vector3d calcVector(ModelNumbers& numbers, const Expression3& expressions, const Quantity& quantity);
FrameNumbers calcFrame(const FrameSpec& frame, ModelNumbers& numbers, const std::string& owner);

/// Throws SimulationFailure also for a mass that is not positive and an inertia that no body has.
MassNumbers calcMassNumbers(const BodySpec& body, ModelNumbers& numbers);

/// Throws SimulationFailure for one below 0.
void checkArmature(const ArmatureSpec& armature, ModelNumbers& numbers);

/// Throws SimulationFailure also for an axis of no length.
JointNumbers calcJointNumbers(const BodySpec& body, ModelNumbers& numbers);

BodyPoint calcBodyPoint(const StationSpec& spec, const SystemNames& names, ModelNumbers& numbers,
                        const std::string& owner);

/// Throws SimulationFailure also for a direction of no length.
OutputNumbers calcOutputNumbers(const OutputSpec& spec, const SystemNames& names, ModelNumbers& numbers);

/// Units of all outputs: m, rad, m/s, rad/s or m/s2, or what expressions state. Throws ExperimentError for
/// unknown coordinates or bodies and for an output that measures nothing or several things.
std::vector<std::string> getOutputUnits(const std::vector<OutputSpec>& outputs, const SystemNames& names);

}  // namespace twinmap
