#pragma once

#include <array>
#include <optional>
#include <type_traits>

#include "framework/experiment/expression/algebra.hpp"
#include "framework/experiment/model/elements/frame_spec.hpp"
#include "kernels/lanes/program/real.hpp"

// What force elements are made of. An element is a template over its scalar S: over Expression it is what the
// experiment file says; over double or program::Symbol it is the numbers of one parameter set. Beside the
// struct stand its description, with units (fields/fields.hpp), and its law, addForces(element, sum), over
// what moves (models/mechanism/equations/force_sum.hpp). All else follows:
// docs/contributing/force-element.md.

namespace twinmap {

/// What of a force can be shown by an output (`force_of`).
struct ForceParts {
  bool along = true;   ///< one number: on its coordinate, between its two points, or on its plane
  bool force = false;  ///< components of the force on a body
  bool moment = false;
};

/// How the experiment file and messages call an element, and what it exerts.
struct ElementKind {
  const char* key;     ///< of the list of such elements: "two_point_springs"
  const char* noun;    ///< "two-point spring"
  const char* what;    ///< "linear springs between two stations"
  ForceParts parts{};  ///< default: a force on a coordinate
};

template <class S>
inline constexpr bool kIsFile = std::is_same_v<S, Expression>;

template <class S>
using BodyOf = std::conditional_t<kIsFile<S>, Name, int>;  ///< 0 is the ground
template <class S>
using CoordinateOf = std::conditional_t<kIsFile<S>, Name, int>;
template <class S>
using OtherCoordinateOf = std::conditional_t<kIsFile<S>, std::optional<Name>, std::optional<int>>;
template <class S>
using VectorOf = std::conditional_t<kIsFile<S>, Expression3, algebra::Vec3<S>>;
template <class S>
using FrameOf = std::conditional_t<kIsFile<S>, FrameSpec, algebra::Transform<S>>;

/// Three values for rotations about x, y, z, then three for translations along them.
template <class S>
using SixOf = std::array<S, 6>;

/// What may depend on coordinates, speeds, signals and time has no value before there is a state, so that the
/// numbers of a parameter set refer to the expression.
template <class S>
using VaryingOf = std::conditional_t<kIsFile<S>, Expression, const Expression*>;
template <class S>
using VaryingVectorOf = std::conditional_t<kIsFile<S>, Expression3, const Expression3*>;

/// A state that an element owns: its name, if it has one, or its place among all states.
template <class S>
using OwnStateOf = std::conditional_t<kIsFile<S>, std::optional<Name>, int>;

/// The name by which outputs call the force of an element; its numbers need none.
struct Nameless {};
template <class S>
using OwnNameOf = std::conditional_t<kIsFile<S>, std::optional<Name>, Nameless>;

template <class Fields, class T>
void describeName(Fields& f, T& name) {
  f.optional("name", name, "for outputs of its force (force_of)");
}

/// Whether a struct is part of an element, with a description of its own.
template <class T>
inline constexpr bool kIsPart = false;

/// A point fixed to a body.
template <class S>
struct Station {
  BodyOf<S> body{};
  VectorOf<S> point{};
};

template <class S>
inline constexpr bool kIsPart<Station<S>> = true;

template <class Fields, class S>
void describe(Fields& f, Station<S>& s) {
  f.required("body", s.body, "a body, or ground", Reference::kBody);
  f.optional("point", s.point, "in the body's frame", Unit{"m"});
}

using StationSpec = Station<Expression>;

/// A plane fixed to a body. A contact's normal points to the side that is free.
template <class S>
struct Plane {
  BodyOf<S> body = makeGround();
  VectorOf<S> point{}, normal{};

 private:
  static BodyOf<S> makeGround() {
    if constexpr (kIsFile<S>) {
      return {"ground", {}};
    } else {
      return 0;
    }
  }
};

template <class S>
inline constexpr bool kIsPart<Plane<S>> = true;

template <class Fields, class S>
void describe(Fields& f, Plane<S>& s) {
  f.optional("body", s.body, "the body that has the plane; default: ground", Reference::kBody);
  f.optional("point", s.point, "of the plane, in its body's frame", Unit{"m"});
  f.required("normal", s.normal, "in its body's frame, of any length; of a contact, towards the free side",
             kNoUnit);
}

using PlaneSpec = Plane<Expression>;

/// A frame fixed to a body.
template <class S>
struct AttachedFrame {
  BodyOf<S> body{};
  FrameOf<S> frame{};
};

template <class S>
inline constexpr bool kIsPart<AttachedFrame<S>> = true;

template <class Fields, class S>
void describe(Fields& f, AttachedFrame<S>& s) {
  f.required("body", s.body, "a body, or ground", Reference::kBody);
  f.optional("frame", s.frame, "a frame fixed to the body");
}

using AttachedFrameSpec = AttachedFrame<Expression>;

/// In which frame the components of a load are given.
enum class ForceFrame { kGround, kBody };

template <>
struct EnumNames<ForceFrame> {
  static constexpr EnumName<ForceFrame> values[] = {{"ground", ForceFrame::kGround},
                                                    {"body", ForceFrame::kBody}};
};

}  // namespace twinmap
