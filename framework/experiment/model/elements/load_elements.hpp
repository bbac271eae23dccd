#pragma once

#include "framework/experiment/model/elements/element.hpp"

namespace twinmap {

/// A force at a station.
template <class S>
struct AppliedForce {
  static constexpr ElementKind kKind{"applied_forces", "force", "forces at stations", {false, true}};
  Station<S> station;
  VaryingVectorOf<S> force{};
  ForceFrame frame = ForceFrame::kGround;
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, AppliedForce<S>& s) {
  f.required("body", s.station.body, "the body it acts on", Reference::kBody);
  f.optional("point", s.station.point, "where it acts, in the body's frame", Unit{"m"});
  f.required("force", s.force, "components; may use excitation signals, coordinates, speeds and t",
             Unit{"N", nullptr, true});
  f.optional("frame", s.frame, "frame of the components");
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const AppliedForce<S>& s, Sum& sum) {
  const algebra::Vec3<S> arm = sum.calcArm(s.station);
  sum.addAt(s.station.body, arm, sum.calcInGround(*s.force, s.frame, s.station.body));
}

/// A moment on a body.
template <class S>
struct AppliedMoment {
  static constexpr ElementKind kKind{"applied_moments", "moment", "moments on bodies", {false, false, true}};
  BodyOf<S> body{};
  VaryingVectorOf<S> moment{};
  ForceFrame frame = ForceFrame::kGround;
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, AppliedMoment<S>& s) {
  f.required("body", s.body, "the body it acts on", Reference::kBody);
  f.required("moment", s.moment, "components; may use excitation signals, coordinates, speeds and t",
             Unit{"N m", nullptr, true});
  f.optional("frame", s.frame, "frame of the components");
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const AppliedMoment<S>& s, Sum& sum) {
  sum.addMoment(s.body, sum.calcInGround(*s.moment, s.frame, s.body));
}

}  // namespace twinmap
