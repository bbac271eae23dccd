#pragma once

#include "framework/experiment/model/elements/element.hpp"

namespace twinmap {

/// Force -stiffness * (q - rest) on a coordinate.
template <class S>
struct Spring {
  static constexpr ElementKind kKind{"springs", "spring", "linear springs on coordinates"};
  CoordinateOf<S> coordinate{};
  S stiffness{}, rest{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, Spring<S>& s) {
  f.required("coordinate", s.coordinate, "force -stiffness * (q - rest) on this coordinate",
             Reference::kForcedCoordinate);
  f.required("stiffness", s.stiffness, "", Unit{"N/m", "N m/rad"});
  f.optional("rest", s.rest, "where the force vanishes", Unit{"m", "rad"});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const Spring<S>& s, Sum& sum) {
  sum.addOnCoordinate(s.coordinate, -(s.stiffness * (sum.getCoordinate(s.coordinate) - s.rest)));
}

/// Force -damping * q' on a coordinate.
template <class S>
struct Damper {
  static constexpr ElementKind kKind{"dampers", "damper", "linear dampers on coordinates"};
  CoordinateOf<S> coordinate{};
  S damping{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, Damper<S>& s) {
  f.required("coordinate", s.coordinate, "force -damping * q' on this coordinate",
             Reference::kForcedCoordinate);
  f.required("damping", s.damping, "", Unit{"N s/m", "N m s/rad"});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const Damper<S>& s, Sum& sum) {
  sum.addOnCoordinate(s.coordinate, -(s.damping * sum.getRate(s.coordinate)));
}

/// A generalized force on a coordinate by expression.
template <class S>
struct ForceLaw {
  static constexpr ElementKind kKind{"force_laws", "force law",
                                     "generalized forces on coordinates, by expression"};
  CoordinateOf<S> coordinate{};
  VaryingOf<S> force{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, ForceLaw<S>& s) {
  f.required("coordinate", s.coordinate, "the coordinate it acts on", Reference::kForcedCoordinate);
  f.required("force", s.force, "may use excitation signals, coordinates, speeds and t",
             Unit{"N", "N m", true});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const ForceLaw<S>& s, Sum& sum) {
  sum.addOnCoordinate(s.coordinate, sum.calc(*s.force));
}

}  // namespace twinmap
