#pragma once

#include "framework/experiment/model/elements/element.hpp"

namespace twinmap {

/// Pulls two stations together by stiffness * (distance - rest_length).
template <class S>
struct TwoPointSpring {
  static constexpr ElementKind kKind{
      "two_point_springs", "two-point spring", "linear springs between two stations", {true, true}};
  Station<S> from, to;
  S stiffness{}, rest_length{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, TwoPointSpring<S>& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("stiffness", s.stiffness, "", Unit{"N/m"});
  f.required("rest_length", s.rest_length, "", Unit{"m"});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const TwoPointSpring<S>& s, Sum& sum) {
  sum.addPull(s.from, s.to,
              [&s](const S& distance, const S&) { return s.stiffness * (distance - s.rest_length); });
}

/// Pulls two stations together by damping * the rate of their distance.
template <class S>
struct TwoPointDamper {
  static constexpr ElementKind kKind{
      "two_point_dampers", "two-point damper", "linear dampers between two stations", {true, true}};
  Station<S> from, to;
  S damping{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, TwoPointDamper<S>& s) {
  f.required("from", s.from, "one end");
  f.required("to", s.to, "other end");
  f.required("damping", s.damping, "", Unit{"N s/m"});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const TwoPointDamper<S>& s, Sum& sum) {
  sum.addPull(s.from, s.to, [&s](const S&, const S& rate) { return s.damping * rate; });
}

/// Linear force between two frames along their six relative coordinates (body-fixed x-y-z angles, then
/// translations, of `to` in `from`), as Simbody's Force::LinearBushing.
template <class S>
struct Bushing {
  static constexpr ElementKind kKind{
      "bushings", "bushing", "linear 6-component elements between two frames", {false, true, true}};
  AttachedFrame<S> from, to;
  SixOf<S> stiffness{}, damping{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, Bushing<S>& s) {
  f.required("from", s.from, "frame on one body");
  f.required("to", s.to, "frame on the other body");
  f.required("stiffness", s.stiffness, "three translational behind three rotational", Unit{"N/m", "N m/rad"});
  f.required("damping", s.damping, "three translational behind three rotational", Unit{"N s/m", "N m s/rad"});
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const Bushing<S>& s, Sum& sum) {
  sum.addBetweenFrames(s.from, s.to, [&s](int direction, const S& q, const S& rate) {
    return -(s.stiffness[direction] * q + s.damping[direction] * rate);
  });
}

}  // namespace twinmap
