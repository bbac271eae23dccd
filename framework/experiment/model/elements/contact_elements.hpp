#pragma once

#include <cstdlib>
#include <limits>
#include <optional>

#include "framework/experiment/model/elements/element.hpp"
#include "framework/experiment/model/elements/memory_elements.hpp"

// Elements that push while something is pressed in, and never pull. By default their forces have no jump, so
// that derivatives of the response are exact without events: what loses energy is in proportion to the depth
// (Hunt and Crossley, J. Applied Mechanics 42, 1975, p. 440). A `damping` acts from the first touch on, which
// is an event, and stops with a restitution are rigid: these switch
// (models/mechanism/equations/switches.hpp).

namespace twinmap {

/// The power of a length that stands in the unit of a stiffness: the exponent, where that is a number; NaN
/// where it is an expression; 1 without one.
template <class S>
double readLengthPower(const std::optional<S>& exponent) {
  if constexpr (kIsFile<S>) {
    if (exponent) {
      char* end = nullptr;
      const double power = std::strtod(exponent->text.c_str(), &end);
      return *end == '\0' ? power : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return 1.0;
}

/// Force at a depth d that grows at the rate d': stiffness d^exponent (1 + dissipation d'), at least 0.
template <class S>
struct ContactLaw {
  S stiffness{}, dissipation{};
  std::optional<S> exponent{};
};

template <class Fields, class S>
void describe(Fields& f, ContactLaw<S>& s) {
  f.required("stiffness", s.stiffness, "force for each unit of depth to the power `exponent`",
             Unit{"N/m", "N m/rad", false, false, readLengthPower(s.exponent)});
  f.optional("exponent", s.exponent, "of the depth; 1.5 for spheres (Hertz); default 1", Unit{"1"});
  f.optional("dissipation", s.dissipation, "share of the force for each unit of speed", Unit{"s/m", "s/rad"});
}

template <class S>
S calcContactForce(const ContactLaw<S>& law, const S& depth, const S& rate) {
  using namespace program::real;
  const S zero = 0.0, one = 1.0, pressed = max(depth, zero);
  const S elastic = law.stiffness * (law.exponent ? calcPower(pressed, *law.exponent) : pressed);
  return elastic * max(one + law.dissipation * rate, zero);
}

/// With a damper while it is pressed: at least 0. `touch`: the element's mode.
template <class S, class Sum>
S calcContactForce(const ContactLaw<S>& law, const std::optional<S>& damping, int touch, const S& depth,
                   const S& rate, const Sum& sum) {
  using namespace program::real;
  const S force = calcContactForce(law, depth, rate);
  return damping ? max(force + sum.calcTouching(touch, depth) * (*damping * rate), S(0.0)) : force;
}

/// A one-sided stop of a coordinate, or of its difference to another, beyond `above` or `below`. An elastic
/// one pushes it back; a rigid one, which has a `restitution` e, throws it back at e times its speed.
template <class S>
struct Stop {
  static constexpr ElementKind kKind{"stops", "stop", "one-sided stops of coordinates"};
  CoordinateOf<S> coordinate{};
  OtherCoordinateOf<S> against{};
  std::optional<S> above{}, below{};
  std::optional<S> stiffness{}, exponent{}, dissipation{}, damping{};
  std::optional<S> restitution{};
  OwnNameOf<S> name{};
  int touch = -1;  ///< of one with damping: its place among the modes of switches

  bool isRigid() const { return restitution.has_value(); }
};

template <class Fields, class S>
void describe(Fields& f, Stop<S>& s) {
  f.required("coordinate", s.coordinate, "the coordinate that is stopped", Reference::kForcedCoordinate);
  f.optional("against", s.against, "a coordinate that it meets: the stop is of their difference",
             Reference::kForcedCoordinate);
  f.optional("above", s.above, "where it begins, towards larger values", Unit{"m", "rad"});
  f.optional("below", s.below, "where it begins, towards smaller values", Unit{"m", "rad"});
  f.optional("stiffness", s.stiffness,
             "of an elastic stop: force for each unit of depth to the power `exponent`",
             Unit{"N/m", "N m/rad", false, false, readLengthPower(s.exponent)});
  f.optional("exponent", s.exponent, "of the depth; 1.5 for spheres (Hertz); default 1", Unit{"1"});
  f.optional("dissipation", s.dissipation, "share of the force for each unit of speed; default 0",
             Unit{"s/m", "s/rad"});
  f.optional("damping", s.damping, "of an elastic stop: force for each unit of speed, from the touch on",
             Unit{"N s/m", "N m s/rad"});
  f.optional("restitution", s.restitution, "of a rigid stop: speed behind an impact for that before, 0 to 1",
             Unit{"1"});
  describeName(f, s.name);
  f.rule(s.above.has_value() != s.below.has_value(), "must give either 'above' or 'below'");
  f.rule(s.stiffness.has_value() != s.restitution.has_value(),
         "must give either 'stiffness' (an elastic stop) or 'restitution' (a rigid one)");
  f.rule(
      !s.restitution || (!s.exponent && !s.dissipation && !s.damping),
      "must not give 'exponent', 'dissipation' or 'damping' with 'restitution': they are of an elastic stop");
}

/// How far a coordinate is from the stop: positive where it is free.
template <class S>
S calcStopGap(const Stop<S>& s, const S& place) {
  return s.above ? *s.above - place : place - *s.below;
}

template <class S, class Sum>
void addForces(const Stop<S>& s, Sum& sum) {
  if (s.isRigid()) {
    return;
  }
  const S apart = sum.calcDifference(s.coordinate, s.against), rate = sum.calcSlip(s.coordinate, s.against);
  const ContactLaw<S> law{*s.stiffness, s.dissipation ? *s.dissipation : S(0.0), s.exponent};
  const S force =
      calcContactForce(law, s.damping, s.touch, S(-calcStopGap(s, apart)), s.above ? rate : S(-rate), sum);
  sum.addBetween(s.coordinate, s.against, s.above ? S(-force) : force);
}

/// Play of a coordinate: no force over the width `gap`, whose middle is at 0, a spring on either side.
template <class S>
struct Backlash {
  static constexpr ElementKind kKind{"backlash", "backlash", "springs with play, on coordinates"};
  CoordinateOf<S> coordinate{};
  OtherCoordinateOf<S> against{};
  S gap{};
  ContactLaw<S> law{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, Backlash<S>& s) {
  f.required("coordinate", s.coordinate, "the coordinate that has play", Reference::kForcedCoordinate);
  f.optional("against", s.against, "the coordinate that it drives: the play is of their difference",
             Reference::kForcedCoordinate);
  f.required("gap", s.gap, "the whole play", Unit{"m", "rad"});
  describe(f, s.law);
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const Backlash<S>& s, Sum& sum) {
  const S apart = sum.calcDifference(s.coordinate, s.against), rate = sum.calcSlip(s.coordinate, s.against);
  const S half = S(0.5) * s.gap;
  const S force =
      calcContactForce(s.law, S(-apart - half), S(-rate)) - calcContactForce(s.law, S(apart - half), rate);
  sum.addBetween(s.coordinate, s.against, force);
}

/// A point of a body against a plane of another, with friction mu N tanh(v / onset_speed) against the
/// sliding speed v.
template <class S>
struct Contact {
  static constexpr ElementKind kKind{"contacts", "contact", "points of bodies against planes", {true, true}};
  Station<S> station;
  Plane<S> plane;
  ContactLaw<S> law{};
  std::optional<S> damping{}, friction{}, onset_speed{};
  OwnNameOf<S> name{};
  int touch = -1;  ///< of one with damping: its place among the modes of switches
};

template <class Fields, class S>
void describe(Fields& f, Contact<S>& s) {
  f.required("body", s.station.body, "the body that touches", Reference::kBody);
  f.optional("point", s.station.point, "of it, in its frame", Unit{"m"});
  f.required("plane", s.plane, "what it touches");
  describe(f, s.law);
  f.optional("damping", s.damping, "force for each unit of speed, from the touch on", Unit{"N s/m"});
  f.optional("friction", s.friction, "coefficient of friction mu", Unit{"1"});
  f.optional("onset_speed", s.onset_speed, "of friction: mu N tanh(v / onset_speed)", Unit{"m/s"});
  describeName(f, s.name);
  f.rule(s.friction.has_value() == s.onset_speed.has_value(),
         "must give 'friction' and 'onset_speed' together");
}

template <class S, class Sum>
void addForces(const Contact<S>& s, Sum& sum) {
  using namespace program::real;
  sum.addOnPlane(s.station, s.plane, [&](const S& depth, const S& rate, const algebra::Vec3<S>& slip) {
    const S pressure = calcContactForce(s.law, s.damping, s.touch, depth, rate, sum);
    if (!s.friction) {
      return std::pair(pressure, algebra::Vec3<S>{S(0.0), S(0.0), S(0.0)});
    }
    constexpr double kAtRest = 1e-12;  // m/s: a speed whose root has a derivative, far below any onset
    const S speed = sqrt(dot(slip, slip) + S(kAtRest * kAtRest));
    return std::pair(pressure,
                     scale(S(-*s.friction * pressure * tanh(speed / *s.onset_speed) / speed), slip));
  });
}

}  // namespace twinmap
