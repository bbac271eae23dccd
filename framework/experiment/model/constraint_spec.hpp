#pragma once

#include <optional>

#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/model/elements/element.hpp"

namespace twinmap {

/// Two points of bodies that are one: closes a loop.
struct CoincidentSpec {
  StationSpec from, to;
};

template <class Fields>
void describe(Fields& f, CoincidentSpec& s) {
  f.required("from", s.from, "a point of one body");
  f.required("to", s.to, "the same point of the other");
}

/// Two points at a constant distance: a rod without mass, hinged at both ends.
struct RodSpec {
  StationSpec from, to;
  Expression length;
};

template <class Fields>
void describe(Fields& f, RodSpec& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("length", s.length, "above 0", Unit{"m"});
}

/// A point of a body that stays in a plane of another: a pin in a slot.
struct PointInPlaneSpec {
  StationSpec station;
  PlaneSpec plane;
};

template <class Fields>
void describe(Fields& f, PointInPlaneSpec& s) {
  f.required("body", s.station.body, "the body whose point stays in the plane", Reference::kBody);
  f.optional("point", s.station.point, "in the body's frame", Unit{"m"});
  f.required("plane", s.plane, "what it stays in");
}

/// A ball or wheel whose center stays a radius from a plane, on the side of its normal, and which touches it
/// without slip: the material of both has one velocity there.
struct RollingSpec {
  StationSpec center;
  Expression radius;
  PlaneSpec plane;
};

template <class Fields>
void describe(Fields& f, RollingSpec& s) {
  f.required("body", s.center.body, "the wheel or ball", Reference::kBody);
  f.optional("point", s.center.point, "its center, in its frame", Unit{"m"});
  f.required("radius", s.radius, "above 0", Unit{"m"});
  f.required("plane", s.plane, "what it rolls on");
}

/// Two frames of bodies that are one: no motion between them.
struct WeldSpec {
  AttachedFrameSpec from, to;
};

template <class Fields>
void describe(Fields& f, WeldSpec& s) {
  f.required("from", s.from, "a frame of one body");
  f.required("to", s.to, "the same frame of the other");
}

/// Two frames of bodies with one origin and one z axis: a hinge that closes a loop.
struct PinSpec {
  AttachedFrameSpec from, to;
};

template <class Fields>
void describe(Fields& f, PinSpec& s) {
  f.required("from", s.from, "a frame of one body; the hinge is its z axis");
  f.required("to", s.to, "a frame of the other with the same origin and z axis");
}

/// coordinate = ratio * driver + offset: gears, a belt, a rack and its pinion, a lead screw.
struct GearSpec {
  Name coordinate, driver;
  Expression ratio, offset;
};

template <class Fields>
void describe(Fields& f, GearSpec& s) {
  f.required("driver", s.driver, "coordinate = ratio * driver + offset", Reference::kForcedCoordinate);
  f.required("coordinate", s.coordinate, "the coordinate that follows", Reference::kForcedCoordinate);
  f.required("ratio", s.ratio, "unit of the coordinate per unit of the driver", kNoUnit);
  f.optional("offset", s.offset, "the coordinate where the driver is 0", Unit{"m", "rad"});
}

/// What bodies must satisfy beside their joints; exactly one of the optional kinds is set.
struct ConstraintSpec {
  SourceLocation where;
  std::optional<Name> name;
  std::optional<CoincidentSpec> coincident;
  std::optional<RodSpec> rod;
  std::optional<PointInPlaneSpec> point_in_plane;
  std::optional<GearSpec> gear;
  std::optional<WeldSpec> weld;
  std::optional<PinSpec> pin;
  std::optional<RollingSpec> rolling;
};

template <class Fields>
void describe(Fields& f, ConstraintSpec& s) {
  f.location(s.where);
  f.optional("name", s.name, "for messages and outputs of its force (force_of)");
  f.oneOf("must give exactly one of",  //
          choice("coincident", s.coincident, "two points of bodies are one"),
          choice("rod", s.rod, "two points keep their distance"),
          choice("point_in_plane", s.point_in_plane, "a point stays in a plane of another body"),
          choice("gear", s.gear, "two coordinates move in a ratio: gears, belts, racks"),
          choice("weld", s.weld, "two frames of bodies are one"),
          choice("pin", s.pin, "two frames of bodies share origin and z axis"),
          choice("rolling", s.rolling, "a wheel or ball rolls on a plane without slip"));
}

}  // namespace twinmap
