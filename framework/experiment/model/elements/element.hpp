#pragma once

#include <array>
#include <optional>
#include <type_traits>

#include "framework/experiment/model/algebra.hpp"
#include "framework/experiment/model/body_spec.hpp"
#include "kernels/lanes/program/real.hpp"

// What force elements are made of. An element is a template over its scalar S: over Expression it is what the
// experiment file says; over double or program::Symbol it is the numbers of one parameter set. Beside the
// struct stand its description, with units (fields/fields.hpp), and its law, addForces(element, sum), over
// what moves (models/mechanism/equations/force_sum.hpp). All else follows:
// docs/contributing/force-element.md.

namespace twinmap {

/// How the experiment file and messages call an element.
struct ElementKind {
  const char* key;   ///< of the list of such elements: "two_point_springs"
  const char* noun;  ///< "two-point spring"
  const char* what;  ///< "linear springs between two stations"
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

/// In which frame the components of a load are given.
enum class ForceFrame { kGround, kBody };

template <>
struct EnumNames<ForceFrame> {
  static constexpr EnumName<ForceFrame> values[] = {{"ground", ForceFrame::kGround},
                                                    {"body", ForceFrame::kBody}};
};

}  // namespace twinmap
