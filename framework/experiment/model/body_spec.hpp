#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/model/elements/frame_spec.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/shape_spec.hpp"

namespace twinmap {

struct JointSpec {
  JointType type = JointType::kWeld;
  std::optional<Name> name;         ///< for outputs; default: that of the body
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
  f.optional("name", s.name, "for outputs of its reaction; default: the name of the body");
  f.optional("parent", s.parent, "ground, or a body declared before", Reference::kEarlierBody);
  f.optional("coordinates", s.coordinates, "a name for each coordinate of the joint");
  f.optional("axis", s.axis, "joint axis in the joint frame (slider x, pin, screw and cylinder z by default)",
             kNoUnit);
  f.optional("pitch", s.pitch, "screw: translation per rotation", Unit{"m/rad"});
  f.optional("in_parent", s.in_parent, "joint frame, fixed to the parent");
  f.optional("in_body", s.in_body, "joint frame, fixed to the body");
}

/// About the joint's axis alone, the whole tensor, or how the mass is spread. The last is of an existing body
/// whatever its six numbers: with the upper triangle S of the spreads (lx, ly, lz on the diagonal) and skews
/// (xy, xz, yz), the second moment of the mass about its centre is m S S', which with the mass is the
/// log-Cholesky form of the pseudo-inertia (Rucker and Wensing 2022).
struct InertiaSpec {
  Expression about_axis{"", {}};        ///< about an axis through the centre of mass, kg m2; "": not given
  Expression3 moments;                  ///< Ixx, Iyy, Izz about the body's own centre of mass, kg m2
  Expression3 products;                 ///< Ixy, Ixz, Iyz (entries of the tensor), kg m2
  std::optional<Expression3> spread{};  ///< m; replaced by moments and products (resolveDefaults)
  std::optional<Expression3> skew{};    ///< m, beside spread
  std::optional<bool> unchecked{};      ///< moments and products that no body has, as of an imported robot
};

inline bool isTensorGiven(const InertiaSpec& inertia) {
  const auto is_given = [](const Expression& entry) { return entry.text != Expression{}.text; };
  return std::any_of(inertia.moments.begin(), inertia.moments.end(), is_given) ||
         std::any_of(inertia.products.begin(), inertia.products.end(), is_given);
}

/// Ixx, Iyy, Izz. A moment about the joint's axis is taken about the other axes too: those do not matter
/// while the body moves in a plane, and a body with three equal moments exists whatever the axis is.
inline Expression3 getMoments(const InertiaSpec& inertia) {
  return inertia.about_axis.text.empty()
             ? inertia.moments
             : Expression3{inertia.about_axis, inertia.about_axis, inertia.about_axis};
}

inline bool isUnchecked(const InertiaSpec& inertia) {
  return inertia.unchecked.value_or(false);
}

template <class Fields>
void describe(Fields& f, InertiaSpec& s) {
  f.scalarIsValueOf("about_axis");
  f.optional("about_axis", s.about_axis,
             "of a body on a pin, planar or cylinder joint: about the joint's axis through the body's own "
             "centre of mass",
             Unit{"kg m2"});
  f.optional("moments", s.moments, "Ixx, Iyy, Izz about the body's own centre of mass", Unit{"kg m2"});
  f.optional("products", s.products, "tensor entries Ixy, Ixz, Iyz", Unit{"kg m2"});
  f.optional("spread", s.spread,
             "root mean square distances of the mass along x, y, z from its centre, less what the skews add: "
             "of an existing body, whatever the values",
             Unit{"m"});
  f.optional("skew", s.skew, "xy, xz, yz: how the spreads lean, beside 'spread'; default 0", Unit{"m"});
  f.optional("unchecked", s.unchecked,
             "take moments and products that no body has, as in a robot's file; only lanes simulate them");
  f.rule((s.about_axis.text.empty() ? 0 : 1) + (isTensorGiven(s) ? 1 : 0) + (s.spread ? 1 : 0) <= 1,
         "must give one of a moment about the joint's axis, 'moments' with 'products', and 'spread'");
  f.rule(!isUnchecked(s) || isTensorGiven(s), "must give 'moments' beside 'unchecked'");
  f.rule(s.spread || !s.skew, "must give 'spread' beside 'skew'");
}

struct BodySpec {
  Name name;
  Expression mass;             ///< kg
  Expression3 center_of_mass;  ///< in the body frame, m
  InertiaSpec inertia;
  JointSpec joint;
  std::optional<bool> massless{};   ///< carries others, and has no mass of its own
  std::vector<ShapeSpec> shapes{};  ///< to be drawn
};

template <class Fields>
void describe(Fields& f, BodySpec& s) {
  f.required("mass", s.mass, "", Unit{"kg"});
  f.optional("center_of_mass", s.center_of_mass, "in the body's frame", Unit{"m"});
  f.optional("inertia", s.inertia, "about the body's own centre of mass");
  f.required("joint", s.joint, "how the body is connected to its parent");
  f.optional("massless", s.massless,
             "beside 'mass: 0': a frame between joints, which carries bodies with mass");
  f.optional("shapes", s.shapes, "what it looks like: drawn, and used by nothing else");
}

}  // namespace twinmap
