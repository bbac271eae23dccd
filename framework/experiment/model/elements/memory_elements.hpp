#pragma once

#include <optional>

#include "framework/experiment/model/elements/element.hpp"

// Elements whose force depends on what happened before: each has a state of its own, whose rate its law
// gives.

namespace twinmap {

/// A number of an element, or, where it depends on coordinates, speeds, states, signals or time, how.
template <class S>
struct StateNumber {
  S value{};
  const Expression* varying = nullptr;  ///< in place of the value
};
template <class S>
using StateNumberOf = std::conditional_t<kIsFile<S>, Expression, StateNumber<S>>;

/// `value` over any scalar; over expressions its `text`.
template <class S>
S makeDefault(double value, const char* text) {
  if constexpr (kIsFile<S>) {
    return {text, {}};
  } else {
    return S(value);
  }
}

/// magnitude^exponent for a magnitude of at least 0, with derivatives that are finite at 0 too.
template <class S>
S calcPower(const S& magnitude, const S& exponent) {
  using namespace program::real;
  constexpr double kSmallest = 1e-300;  // its logarithm is finite, and it vanishes beside all that counts
  return pow(max(magnitude, S(kSmallest)), exponent);
}

/// The bristle of LuGre friction: its deflection is a state.
template <class S>
struct Bristle {
  static constexpr bool kInUnitOfCoordinate = true;
  OwnStateOf<S> state{};
  S stiffness{}, damping{}, initial{};
};

template <class S>
inline constexpr bool kIsPart<Bristle<S>> = true;

template <class Fields, class S>
void describe(Fields& f, Bristle<S>& s) {
  f.optional("state", s.state, "a name for its deflection, which expressions may then use");
  f.required("stiffness", s.stiffness, "", Unit{"N/m", "N m/rad"});
  f.optional("damping", s.damping, "of the bristle itself", Unit{"N s/m", "N m s/rad"});
  f.optional("initial", s.initial, "deflection at the start", Unit{"m", "rad"});
}

/// Friction that falls from `level` at rest to the Coulomb level: Fc + (level - Fc) exp(-(|v| /
/// speed)^exponent).
template <class S>
struct Stribeck {
  StateNumberOf<S> level{};
  S speed{}, exponent = makeDefault<S>(2.0, "2");
};

template <class S>
inline constexpr bool kIsPart<Stribeck<S>> = true;

template <class Fields, class S>
void describe(Fields& f, Stribeck<S>& s) {
  f.required("level", s.level, "of friction at rest; may depend on load as 'coulomb'",
             Unit{"N", "N m", true});
  f.required("speed", s.speed, "over which it falls to the Coulomb level", Unit{"m/s", "rad/s"});
  f.optional("exponent", s.exponent, "of the speed", Unit{"1"});
}

enum class FrictionModel { kLugre, kRegularised, kCoulomb };

template <>
struct EnumNames<FrictionModel> {
  static constexpr EnumName<FrictionModel> values[] = {{"lugre", FrictionModel::kLugre},
                                                       {"regularised", FrictionModel::kRegularised},
                                                       {"coulomb", FrictionModel::kCoulomb}};
};

/// Friction on a coordinate, or between two, with g(v) the Coulomb or Stribeck level at the sliding speed v,
/// the coordinate's rate less that of the other and of the surface. The levels and the viscous factor may
/// depend on load: on coordinates, speeds, states and signals.
/// - lugre (IEEE Trans. Automatic Control 40, 1995, p. 419): dz/dt = v - s0 |v| z / g(v), force
///   -(s0 z + s1 dz/dt + viscous v), with stiffness s0 and damping s1 of the bristle;
/// - regularised: force -(g(v) tanh(v / onset_speed) + viscous v), which creeps under any load;
/// - coulomb: it sticks while that takes at most g(0), else force -(g(v) sign(v) + viscous v). It switches
///   (models/mechanism/equations/switches.hpp), unless a motion is prescribed: that says itself where it is
///   at rest.
template <class S>
struct Friction {
  static constexpr ElementKind kKind{"friction", "friction", "friction on coordinates"};
  CoordinateOf<S> coordinate{};
  OtherCoordinateOf<S> against{};
  FrictionModel model = FrictionModel::kLugre;
  StateNumberOf<S> coulomb{}, viscous{};
  std::optional<Stribeck<S>> stribeck{};
  std::optional<Bristle<S>> bristle{};
  std::optional<S> onset_speed{}, surface_speed{};
  OwnNameOf<S> name{};
  int mode = -1;               ///< of coulomb: its place among the modes of switches
  bool is_prescribed = false;  ///< whether its speed is that of signals

  bool switches() const { return model == FrictionModel::kCoulomb && !is_prescribed; }
};

template <class Fields, class S>
void describe(Fields& f, Friction<S>& s) {
  f.required("coordinate", s.coordinate, "the coordinate that slides", Reference::kForcedCoordinate);
  f.optional("against", s.against, "the coordinate that it slides against; default: what does not move",
             Reference::kForcedCoordinate);
  f.required("model", s.model,
             "lugre: a bristle that sticks and slips; regularised: tanh; coulomb: exact sticking");
  f.required("coulomb", s.coulomb,
             "level of friction while sliding; may use excitation signals, coordinates, speeds, states and t",
             Unit{"N", "N m", true});
  f.optional("viscous", s.viscous, "force for each unit of speed; likewise",
             Unit{"N s/m", "N m s/rad", true});
  f.optional("stribeck", s.stribeck, "a higher level at rest");
  f.optional("bristle", s.bristle, "of lugre");
  f.optional("onset_speed", s.onset_speed, "of regularised: tanh(v / onset_speed)", Unit{"m/s", "rad/s"});
  f.optional("surface_speed", s.surface_speed, "of what it slides on, as of a belt; default 0",
             Unit{"m/s", "rad/s"});
  describeName(f, s.name);
  f.rule((s.model == FrictionModel::kLugre) == s.bristle.has_value(),
         "must give 'bristle' with 'model: lugre', and only there");
  f.rule((s.model == FrictionModel::kRegularised) == s.onset_speed.has_value(),
         "must give 'onset_speed' with 'model: regularised', and only there");
}

/// g(v) of Friction.
template <class S, class Sum>
S calcSlidingLevel(const Friction<S>& s, const S& speed, const Sum& sum) {
  using namespace program::real;
  const S coulomb = sum.calc(s.coulomb);
  if (!s.stribeck) {
    return coulomb;
  }
  const S fall = exp(-calcPower(S(speed / s.stribeck->speed), s.stribeck->exponent));
  return coulomb + (sum.calc(s.stribeck->level) - coulomb) * fall;
}

template <class S, class Sum>
void addForces(const Friction<S>& s, Sum& sum) {
  using namespace program::real;
  const S rate = sum.calcSlip(s.coordinate, s.against);
  const S v = s.surface_speed ? S(rate - *s.surface_speed) : rate;
  const S speed = abs(v), level = calcSlidingLevel(s, speed, sum);
  S friction = sum.calc(s.viscous) * v;
  if (s.bristle) {
    const S& deflection = sum.getState(s.bristle->state);
    const S change = v - s.bristle->stiffness * speed * deflection / level;
    sum.setStateRate(s.bristle->state, change);
    friction = s.bristle->stiffness * deflection + s.bristle->damping * change + friction;
  } else if (s.model == FrictionModel::kCoulomb) {
    friction = (s.is_prescribed ? S(sign(v) * level) : sum.calcSided(s.mode, level)) + friction;
  } else {
    friction = level * tanh(v / *s.onset_speed) + friction;
  }
  sum.addBetween(s.coordinate, s.against, S(-friction));
}

/// The level that it holds at rest.
template <class S>
const StateNumberOf<S>& getStaticLevel(const Friction<S>& s) {
  return s.stribeck ? s.stribeck->level : s.coulomb;
}

/// A spring of which part yields (Bouc 1967, Wen 1976), on a coordinate q. The state z has no unit:
///   dz/dt = v / yield (A - |z|^exponent (beta sign(v z) + gamma)), v = q',
///   force -(elastic_share stiffness q + (1 - elastic_share) stiffness yield z).
template <class S>
struct BoucWen {
  static constexpr bool kInUnitOfCoordinate = false;
  OwnStateOf<S> state{};
  S stiffness{}, elastic_share{}, yield{};
  S amplitude = makeDefault<S>(1.0, "1"), beta = makeDefault<S>(0.5, "0.5"),
    gamma = makeDefault<S>(0.5, "0.5"), exponent = makeDefault<S>(1.0, "1");
  S initial{};
};

template <class S>
inline constexpr bool kIsPart<BoucWen<S>> = true;

template <class Fields, class S>
void describe(Fields& f, BoucWen<S>& s) {
  f.optional("state", s.state, "a name for its state z, which expressions may then use");
  f.required("stiffness", s.stiffness, "before it yields", Unit{"N/m", "N m/rad"});
  f.required("elastic_share", s.elastic_share, "of the stiffness, left after it has yielded", Unit{"1"});
  f.required("yield", s.yield, "displacement at which it yields", Unit{"m", "rad"});
  f.optional("amplitude", s.amplitude, "A", Unit{"1"});
  f.optional("beta", s.beta,
             "shape of the loop; with gamma and A, |z| ends at (A / (beta + gamma))^(1/exponent)", Unit{"1"});
  f.optional("gamma", s.gamma, "shape of the loop", Unit{"1"});
  f.optional("exponent", s.exponent, "how sharply it yields", Unit{"1"});
  f.optional("initial", s.initial, "z at the start", Unit{"1"});
}

template <class S>
struct Hysteresis {
  static constexpr ElementKind kKind{"hysteresis", "hysteresis", "springs that yield, on coordinates"};
  CoordinateOf<S> coordinate{};
  BoucWen<S> bouc_wen{};
  OwnNameOf<S> name{};
};

template <class Fields, class S>
void describe(Fields& f, Hysteresis<S>& s) {
  f.required("coordinate", s.coordinate, "the coordinate it acts on", Reference::kForcedCoordinate);
  f.required("bouc_wen", s.bouc_wen, "the model of Bouc and Wen");
  describeName(f, s.name);
}

template <class S, class Sum>
void addForces(const Hysteresis<S>& s, Sum& sum) {
  using namespace program::real;
  const BoucWen<S>& law = s.bouc_wen;
  const S& v = sum.getRate(s.coordinate);
  const S& z = sum.getState(law.state);
  const S power = calcPower(S(abs(z)), law.exponent);
  const S side = sign(z) * abs(v);  // v sign(v z)
  sum.setStateRate(law.state, (law.amplitude * v - power * (law.beta * side + law.gamma * v)) / law.yield);
  const S elastic = law.elastic_share * law.stiffness * sum.getCoordinate(s.coordinate);
  const S yielding = (S(1.0) - law.elastic_share) * law.stiffness * law.yield * z;
  sum.addOnCoordinate(s.coordinate, -(elastic + yielding));
}

/// action(part, coordinate) of each state that an element owns: `part` has its name or place (`state`) and
/// its `initial` value. Most elements have none.
template <class Element, class Action>
void forEachOwnState(Element&, Action) {}
template <class S, class Action>
void forEachOwnState(Friction<S>& s, Action action) {
  if (s.bristle) {
    action(*s.bristle, s.coordinate);
  }
}
template <class S, class Action>
void forEachOwnState(const Friction<S>& s, Action action) {
  if (s.bristle) {
    action(*s.bristle, s.coordinate);
  }
}
template <class S, class Action>
void forEachOwnState(Hysteresis<S>& s, Action action) {
  action(s.bouc_wen, s.coordinate);
}
template <class S, class Action>
void forEachOwnState(const Hysteresis<S>& s, Action action) {
  action(s.bouc_wen, s.coordinate);
}

}  // namespace twinmap
