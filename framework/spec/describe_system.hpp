#pragma once

#include "framework/spec/fields/fields.hpp"
#include "framework/spec/system_spec.hpp"

namespace twinmap {

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

template <>
struct EnumNames<ForceFrame> {
  static constexpr EnumName<ForceFrame> values[] = {{"ground", ForceFrame::kGround},
                                                    {"body", ForceFrame::kBody}};
};

template <>
struct EnumNames<EquilibriumAt> {
  static constexpr EnumName<EquilibriumAt> values[] = {{"box_center", EquilibriumAt::kBoxCenter},
                                                       {"sample", EquilibriumAt::kSample}};
};

template <class Fields>
void describe(Fields& f, FrameSpec& s) {
  f.optional("point", s.point, "origin of the frame, in the body's frame; m");
  f.optional("orientation", s.orientation, "body-fixed x-y-z angles; rad");
}

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

template <class Fields>
void describe(Fields& f, InertiaSpec& s) {
  f.optional("moments", s.moments, "Ixx, Iyy, Izz about the body's own centre of mass; kg m2");
  f.optional("products", s.products, "tensor entries Ixy, Ixz, Iyz; kg m2");
}

template <class Fields>
void describe(Fields& f, BodySpec& s) {
  f.required("mass", s.mass, "kg");
  f.optional("center_of_mass", s.center_of_mass, "in the body's frame; m");
  f.optional("inertia", s.inertia, "about the body's own centre of mass");
  f.required("joint", s.joint, "how the body is connected to its parent");
}

template <class Fields>
void describe(Fields& f, SpringSpec& s) {
  f.required("coordinate", s.coordinate, "force -stiffness * (q - rest) on this coordinate");
  f.required("stiffness", s.stiffness, "N/m or N m/rad");
  f.optional("rest", s.rest, "where the force vanishes; m or rad");
}

template <class Fields>
void describe(Fields& f, DamperSpec& s) {
  f.required("coordinate", s.coordinate, "force -damping * q' on this coordinate");
  f.required("damping", s.damping, "N s/m or N m s/rad");
}

template <class Fields>
void describe(Fields& f, StationSpec& s) {
  f.required("body", s.body, "a body, or ground");
  f.optional("point", s.point, "in the body's frame; m");
}

template <class Fields>
void describe(Fields& f, TwoPointSpringSpec& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("stiffness", s.stiffness, "N/m");
  f.required("rest_length", s.rest_length, "m");
}

template <class Fields>
void describe(Fields& f, TwoPointDamperSpec& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("damping", s.damping, "N s/m");
}

template <class Fields>
void describe(Fields& f, BodyFrameSpec& s) {
  f.required("body", s.body, "a body, or ground");
  f.optional("frame", s.frame, "a frame fixed to the body");
}

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

template <class Fields>
void describe(Fields& f, AppliedForceSpec& s) {
  f.required("body", s.station.body, "the body it acts on");
  f.optional("point", s.station.point, "where it acts, in the body's frame; m");
  f.required("force", s.force, "components; may use excitation signals, coordinates, speeds and t; N");
  f.optional("frame", s.frame, "frame of the components");
}

template <class Fields>
void describe(Fields& f, AppliedMomentSpec& s) {
  f.required("body", s.body, "the body it acts on");
  f.required("moment", s.moment, "components; may use excitation signals, coordinates, speeds and t; N m");
  f.optional("frame", s.frame, "frame of the components");
}

template <class Fields>
void describe(Fields& f, ForceLawSpec& s) {
  f.required("coordinate", s.coordinate, "the coordinate it acts on");
  f.required("force", s.force, "may use excitation signals, coordinates, speeds and t; N or N m");
}

template <class Fields>
void describe(Fields& f, SystemSpec& s) {
  f.optional("gravity", s.gravity, "in the ground frame; m/s2");
  f.requiredMap("bodies", s.bodies, "each with its joint to a parent declared before");
  f.optional("springs", s.springs, "linear springs on coordinates");
  f.optional("dampers", s.dampers, "linear dampers on coordinates");
  f.optional("two_point_springs", s.two_point_springs, "linear springs between two stations");
  f.optional("two_point_dampers", s.two_point_dampers, "linear dampers between two stations");
  f.optional("bushings", s.bushings, "linear 6-component elements between two frames");
  f.optional("applied_forces", s.applied_forces, "forces at stations");
  f.optional("applied_moments", s.applied_moments, "moments on bodies");
  f.optional("force_laws", s.force_laws, "generalized forces on coordinates, by expression");
}

template <class Fields>
void describe(Fields& f, StationOutputSpec& s) {
  f.required("body", s.station.body, "a body");
  f.optional("point", s.station.point, "in the body's frame; m");
  f.required("direction", s.direction, "in the ground frame; normalised");
}

template <class Fields>
void describe(Fields& f, OutputSpec& s) {
  f.optional("coordinate", s.coordinate, "a joint coordinate; m or rad");
  f.optional("speed", s.speed, "time derivative of a joint coordinate; m/s or rad/s");
  f.optional("position", s.position, "of a station, along a direction; m");
  f.optional("velocity", s.velocity, "of a station, along a direction; m/s");
  f.optional("acceleration", s.acceleration, "of a station, along a direction; m/s2");
  f.optional("gain", s.gain, "of the sensor, which measures gain * quantity + offset; default 1");
  f.optional("offset", s.offset, "of the sensor, in the quantity's unit; default 0");
  const int given = s.coordinate.has_value() + s.speed.has_value() + s.position.has_value() +
                    s.velocity.has_value() + s.acceleration.has_value();
  f.rule(given == 1, "must give exactly one of coordinate, speed, position, velocity, acceleration");
}

template <class Fields>
void describe(Fields& f, EquilibriumSpec& s) {
  f.optional("at", s.at, "one equilibrium at the centre of the parameter box, or each sample's own");
  f.optionalMap("parameters", s.parameters, "values that replace the centre's");
  f.rule(s.at == EquilibriumAt::kBoxCenter || s.parameters.empty(),
         "must not give parameters together with 'at: sample'");
}

template <class Fields>
void describe(Fields& f, InitialSpec& s) {
  f.optionalMap("coordinates", s.coordinates, "initial values, or where Newton's method starts; others 0");
  f.optionalMap("speeds", s.speeds, "initial time derivatives of coordinates; others 0");
  f.optional("equilibrium", s.equilibrium, "start at rest in the static equilibrium, without excitation");
  f.rule(!s.equilibrium || s.speeds.empty(), "must not give speeds together with an equilibrium");
}

}  // namespace twinmap
