#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

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

template <>
struct EnumNames<JointType> {
  static constexpr EnumName<JointType> values[] = {
      {"weld", JointType::kWeld},
      {"slider", JointType::kSlider},
      {"pin", JointType::kPin},
      {"screw", JointType::kScrew},
      {"cylinder", JointType::kCylinder},
      {"universal", JointType::kUniversal},
      {"bend_stretch", JointType::kBendStretch},
      {"planar", JointType::kPlanar},
      {"translation", JointType::kTranslation},
      {"gimbal", JointType::kGimbal},
      {"ball", JointType::kBall},
      {"bushing", JointType::kBushing},
      {"free", JointType::kFree},
  };
};

/// A frame fixed to a body: its origin and its orientation as body-fixed x-y-z angles (rad).
struct FrameSpec {
  Expression3 point;
  Expression3 orientation;
};

template <class Fields>
void describe(Fields& f, FrameSpec& s) {
  f.optional("point", s.point, "origin of the frame, in the body's frame; m");
  f.optional("orientation", s.orientation, "body-fixed x-y-z angles; rad");
}

struct JointSpec {
  JointType type = JointType::kWeld;
  Name parent{"ground", {}};        ///< "ground" or a body declared before
  std::optional<Expression3> axis;  ///< joint axis in the joint frame; only for 1-axis joints
  Expression pitch{"", {}};         ///< m/rad, screw only
  std::vector<Name> coordinates;    ///< one name per coordinate, unique in the system
  FrameSpec in_parent;              ///< joint frame fixed to the parent
  FrameSpec in_body;                ///< joint frame fixed to the body
};

template <class Fields>
void describe(Fields& f, JointSpec& s) {
  f.required("type", s.type, "kind of joint");
  f.optional("parent", s.parent, "ground, or a body declared before");
  f.optional("coordinates", s.coordinates, "a name for each coordinate of the joint");
  f.optional("axis", s.axis,
             "joint axis in the joint frame (slider x, pin, screw and cylinder z by default)");
  f.optional("pitch", s.pitch, "screw: translation per rotation; m/rad");
  f.optional("in_parent", s.in_parent, "joint frame, fixed to the parent");
  f.optional("in_body", s.in_body, "joint frame, fixed to the body");
}

struct InertiaSpec {
  Expression3 moments;   ///< Ixx, Iyy, Izz about the body's own centre of mass, kg m2
  Expression3 products;  ///< Ixy, Ixz, Iyz (entries of the tensor), kg m2
};

template <class Fields>
void describe(Fields& f, InertiaSpec& s) {
  f.optional("moments", s.moments, "Ixx, Iyy, Izz about the body's own centre of mass; kg m2");
  f.optional("products", s.products, "tensor entries Ixy, Ixz, Iyz; kg m2");
}

struct BodySpec {
  Name name;
  Expression mass;             ///< kg
  Expression3 center_of_mass;  ///< in the body frame, m
  InertiaSpec inertia;
  JointSpec joint;
};

template <class Fields>
void describe(Fields& f, BodySpec& s) {
  f.required("mass", s.mass, "kg");
  f.optional("center_of_mass", s.center_of_mass, "in the body's frame; m");
  f.optional("inertia", s.inertia, "about the body's own centre of mass");
  f.required("joint", s.joint, "how the body is connected to its parent");
}

}  // namespace twinmap
