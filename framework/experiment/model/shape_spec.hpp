#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

/// A cylinder, or a capsule, whose half spheres lie beyond the length; along z, its middle at the origin.
struct RoundShapeSpec {
  double radius = 0.0, length = 0.0;  ///< m
};

template <class Fields>
void describe(Fields& f, RoundShapeSpec& s) {
  f.required("radius", s.radius, "m", kPositive);
  f.required("length", s.length, "along z; of a capsule without its ends; m", kPositive);
}

/// What a body looks like. It is drawn, and nothing is computed from it: plain numbers, no expressions.
struct ShapeSpec {
  std::optional<std::array<double, 3>> box;  ///< edges along x, y, z, m
  std::optional<RoundShapeSpec> cylinder, capsule;
  std::optional<double> sphere;  ///< radius, m
  std::optional<Name> mesh;      ///< file; absolute once read
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  std::array<double, 3> point{}, orientation{};  ///< of its frame in the body's, as of FrameSpec
};

template <class Fields>
void describe(Fields& f, ShapeSpec& s) {
  f.oneOf("must give exactly one of", choice("box", s.box, "its edges along x, y, z; m"),
          choice("cylinder", s.cylinder, "along z, its middle at 'point'"),
          choice("capsule", s.capsule, "along z, its middle at 'point'"),
          choice("sphere", s.sphere, "its radius; m", kPositive),
          choice("mesh", s.mesh, "a file, STL, OBJ or Collada, in m; relative to the experiment file"));
  f.optional("scale", s.scale, "of a mesh along x, y, z: 0.001 each for one in mm; default 1");
  f.optional("point", s.point, "of its frame, in the body's frame; m; default 0");
  f.optional("orientation", s.orientation, "of its frame: body-fixed x-y-z angles; rad; default 0");
  f.rule(!s.box || *std::min_element(s.box->begin(), s.box->end()) > 0.0, "must give edges above 0 in 'box'");
  f.rule(s.mesh || s.scale == ShapeSpec{}.scale, "must give 'scale' beside 'mesh' alone");
}

}  // namespace twinmap
