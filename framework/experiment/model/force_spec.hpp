#pragma once

#include <vector>

#include "framework/experiment/model/body_spec.hpp"

namespace twinmap {

/// Force -stiffness * (q - rest) on a coordinate.
struct SpringSpec {
  Name coordinate;
  Expression stiffness;  ///< N/m or N m/rad
  Expression rest;       ///< m or rad
};

template <class Fields>
void describe(Fields& f, SpringSpec& s) {
  f.required("coordinate", s.coordinate, "force -stiffness * (q - rest) on this coordinate");
  f.required("stiffness", s.stiffness, "N/m or N m/rad");
  f.optional("rest", s.rest, "where the force vanishes; m or rad");
}

/// Force -damping * q' on a coordinate.
struct DamperSpec {
  Name coordinate;
  Expression damping;  ///< N s/m or N m s/rad
};

template <class Fields>
void describe(Fields& f, DamperSpec& s) {
  f.required("coordinate", s.coordinate, "force -damping * q' on this coordinate");
  f.required("damping", s.damping, "N s/m or N m s/rad");
}

/// A point fixed to a body (in the body frame, m); body "ground" is the inertial frame.
struct StationSpec {
  Name body;
  Expression3 point;
};

template <class Fields>
void describe(Fields& f, StationSpec& s) {
  f.required("body", s.body, "a body, or ground");
  f.optional("point", s.point, "in the body's frame; m");
}

struct TwoPointSpringSpec {
  StationSpec from, to;
  Expression stiffness;    ///< N/m
  Expression rest_length;  ///< m
};

template <class Fields>
void describe(Fields& f, TwoPointSpringSpec& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("stiffness", s.stiffness, "N/m");
  f.required("rest_length", s.rest_length, "m");
}

struct TwoPointDamperSpec {
  StationSpec from, to;
  Expression damping;  ///< N s/m
};

template <class Fields>
void describe(Fields& f, TwoPointDamperSpec& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("damping", s.damping, "N s/m");
}

/// A frame on a body, for bushings.
struct BodyFrameSpec {
  Name body;
  FrameSpec frame;
};

template <class Fields>
void describe(Fields& f, BodyFrameSpec& s) {
  f.required("body", s.body, "a body, or ground");
  f.optional("frame", s.frame, "a frame fixed to the body");
}

/// Linear force between two frames: three angles (body-fixed x-y-z), then three translations.
struct BushingSpec {
  BodyFrameSpec from, to;
  std::vector<Expression> stiffness;  ///< 6: N m/rad, N m/rad, N m/rad, N/m, N/m, N/m
  std::vector<Expression> damping;    ///< 6: N m s/rad ..., N s/m ...
};

template <class Fields>
void describe(Fields& f, BushingSpec& s) {
  f.required("from", s.from, "frame on one body");
  f.required("to", s.to, "frame on the other body");
  f.required("stiffness", s.stiffness, "three rotational (N m/rad), then three translational (N/m)");
  f.required("damping", s.damping, "three rotational (N m s/rad), then three translational (N s/m)");
  constexpr std::size_t kDirections = 6;
  f.rule(s.stiffness.size() == kDirections, "must give 6 values of stiffness");
  f.rule(s.damping.size() == kDirections, "must give 6 values of damping");
}

enum class ForceFrame { kGround, kBody };

template <>
struct EnumNames<ForceFrame> {
  static constexpr EnumName<ForceFrame> values[] = {{"ground", ForceFrame::kGround},
                                                    {"body", ForceFrame::kBody}};
};

/// A force at a station. Components may use constants, parameters, coordinates, speeds (<coordinate>_dot),
/// excitation signals and the time t.
struct AppliedForceSpec {
  StationSpec station;
  Expression3 force;  ///< N
  ForceFrame frame = ForceFrame::kGround;
};

template <class Fields>
void describe(Fields& f, AppliedForceSpec& s) {
  f.required("body", s.station.body, "the body it acts on");
  f.optional("point", s.station.point, "where it acts, in the body's frame; m");
  f.required("force", s.force, "components; may use excitation signals, coordinates, speeds and t; N");
  f.optional("frame", s.frame, "frame of the components");
}

struct AppliedMomentSpec {
  Name body;
  Expression3 moment;  ///< N m
  ForceFrame frame = ForceFrame::kGround;
};

template <class Fields>
void describe(Fields& f, AppliedMomentSpec& s) {
  f.required("body", s.body, "the body it acts on");
  f.required("moment", s.moment, "components; may use excitation signals, coordinates, speeds and t; N m");
  f.optional("frame", s.frame, "frame of the components");
}

/// A generalized force on a coordinate by expression, with the same names as AppliedForceSpec.
struct ForceLawSpec {
  Name coordinate;
  Expression force;  ///< N or N m
};

template <class Fields>
void describe(Fields& f, ForceLawSpec& s) {
  f.required("coordinate", s.coordinate, "the coordinate it acts on");
  f.required("force", s.force, "may use excitation signals, coordinates, speeds and t; N or N m");
}

}  // namespace twinmap
