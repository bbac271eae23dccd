#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/spec/expression/expression.hpp"

namespace twinmap {

/// Mobilities between a body and its parent. Coordinates in the order and units given in
/// docs/experiment-file.md; angles in rad, lengths in m.
enum class JointType {
  kWeld,         // 0 coordinates
  kSlider,       // 1: translation along `axis`
  kPin,          // 1: rotation about `axis`
  kScrew,        // 1: rotation about `axis`, translating by `pitch` m/rad
  kCylinder,     // 2: rotation about and translation along `axis`
  kUniversal,    // 2: rotations about x, then y
  kBendStretch,  // 2: rotation about z, then translation along the rotated x
  kPlanar,       // 3: rotation about z, translations along x and y
  kTranslation,  // 3: translations x, y, z
  kGimbal,       // 3: body-fixed x-y-z angles
  kBall,         // 3: body-fixed x-y-z angles, speeds are the angular velocity
  kBushing,      // 6: body-fixed x-y-z angles, translations
  kFree,         // 6: body-fixed x-y-z angles, translations; speeds are angular and linear velocity
};

/// A frame fixed to a body: its origin and its orientation as body-fixed x-y-z angles (rad).
struct FrameSpec {
  Expression3 point;
  Expression3 orientation;
};

struct JointSpec {
  JointType type = JointType::kWeld;
  Name parent{"ground", {}};        ///< "ground" or a body declared before
  std::optional<Expression3> axis;  ///< joint axis in the joint frame; only for 1-axis joints
  Expression pitch{"", {}};         ///< m/rad, screw only
  std::vector<Name> coordinates;    ///< one name per coordinate, unique in the system
  FrameSpec in_parent;              ///< joint frame fixed to the parent
  FrameSpec in_body;                ///< joint frame fixed to the body
};

struct InertiaSpec {
  Expression3 moments;   ///< Ixx, Iyy, Izz about the body's own centre of mass, kg m2
  Expression3 products;  ///< Ixy, Ixz, Iyz (entries of the tensor), kg m2
};

struct BodySpec {
  Name name;
  Expression mass;             ///< kg
  Expression3 center_of_mass;  ///< in the body frame, m
  InertiaSpec inertia;
  JointSpec joint;
};

/// Force -stiffness * (q - rest) on a coordinate.
struct SpringSpec {
  Name coordinate;
  Expression stiffness;  ///< N/m or N m/rad
  Expression rest;       ///< m or rad
};

/// Force -damping * q' on a coordinate.
struct DamperSpec {
  Name coordinate;
  Expression damping;  ///< N s/m or N m s/rad
};

/// A point fixed to a body (in the body frame, m); body "ground" is the inertial frame.
struct StationSpec {
  Name body;
  Expression3 point;
};

struct TwoPointSpringSpec {
  StationSpec from, to;
  Expression stiffness;    ///< N/m
  Expression rest_length;  ///< m
};

struct TwoPointDamperSpec {
  StationSpec from, to;
  Expression damping;  ///< N s/m
};

/// A frame on a body, for bushings.
struct BodyFrameSpec {
  Name body;
  FrameSpec frame;
};

/// Linear force between two frames: three angles (body-fixed x-y-z), then three translations.
struct BushingSpec {
  BodyFrameSpec from, to;
  std::vector<Expression> stiffness;  ///< 6: N m/rad, N m/rad, N m/rad, N/m, N/m, N/m
  std::vector<Expression> damping;    ///< 6: N m s/rad ..., N s/m ...
};

enum class ForceFrame { kGround, kBody };

/// A force at a station. Components may use constants, parameters, coordinates, speeds (<coordinate>_dot),
/// excitation signals and the time t.
struct AppliedForceSpec {
  StationSpec station;
  Expression3 force;  ///< N
  ForceFrame frame = ForceFrame::kGround;
};

struct AppliedMomentSpec {
  Name body;
  Expression3 moment;  ///< N m
  ForceFrame frame = ForceFrame::kGround;
};

/// A generalized force on a coordinate by expression, with the same names as AppliedForceSpec.
struct ForceLawSpec {
  Name coordinate;
  Expression force;  ///< N or N m
};

struct SystemSpec {
  Expression3 gravity;  ///< m/s2, in the ground frame; zero by default
  std::vector<BodySpec> bodies;
  std::vector<SpringSpec> springs;
  std::vector<DamperSpec> dampers;
  std::vector<TwoPointSpringSpec> two_point_springs;
  std::vector<TwoPointDamperSpec> two_point_dampers;
  std::vector<BushingSpec> bushings;
  std::vector<AppliedForceSpec> applied_forces;
  std::vector<AppliedMomentSpec> applied_moments;
  std::vector<ForceLawSpec> force_laws;
};

/// One measured quantity of the system: gain * quantity + offset; exactly one of the optional members is set.
/// Speeds are time derivatives of coordinates; positions, velocities and accelerations are of a station, in
/// the ground frame, along `direction` (normalised).
struct StationOutputSpec {
  StationSpec station;
  Expression3 direction;
};

struct OutputSpec {
  Name name;
  std::optional<Name> coordinate;
  std::optional<Name> speed;
  std::optional<StationOutputSpec> position;
  std::optional<StationOutputSpec> velocity;
  std::optional<StationOutputSpec> acceleration;
  Expression gain{"", {}};    ///< of the sensor, dimensionless; 1 if not given
  Expression offset{"", {}};  ///< of the sensor, in the quantity's unit; 0 if not given
};

/// Values by name, in file order (initial coordinates, reference parameters ...).
struct NamedExpression {
  Name name;
  Expression value;
};

enum class EquilibriumAt { kBoxCenter, kSample };

/// Start at rest where all accelerations vanish, without excitation.
struct EquilibriumSpec {
  EquilibriumAt at = EquilibriumAt::kBoxCenter;  ///< one equilibrium for all samples, or each sample its own
  std::vector<NamedExpression> parameters;       ///< with kBoxCenter: values that replace the centre's
};

struct InitialSpec {
  std::vector<NamedExpression> coordinates;  ///< initial values, or the start of Newton's method; default 0
  std::vector<NamedExpression> speeds;       ///< initial time derivatives; not with an equilibrium; default 0
  std::optional<EquilibriumSpec> equilibrium;
};

}  // namespace twinmap
