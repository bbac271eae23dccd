#include "framework/models/mechanism/lanes/recording/recorded_events.hpp"

#include <limits>

#include "framework/models/mechanism/equations/impulse.hpp"

namespace twinmap {
namespace {

using equations::ModelState;
using equations::Pair;
using program::Symbol;
using Symbols = std::vector<Symbol>;

/// Flights shorter than this part of the simulation are rest: at their speeds, a millionth of those of
/// flights that are seen, no output that is measured tells the difference.
constexpr double kShortestFlight = 1e-6;
/// Of what is compared: numbers this close differ by rounding alone.
constexpr double kEqualTo = 1e-12;

Symbol calcSide(const Symbol& speed) {
  return select(less(Symbol(0.0), speed), Symbol(1.0),
                select(less(speed, Symbol(0.0)), Symbol(-1.0), Symbol(0.0)));
}

/// What an event changes.
struct Behind {
  Symbols coordinates, speeds, modes;
};

class EventRecorder {
  using Touch = equations::TouchMotion<Symbol>;

 public:
  explicit EventRecorder(const SwitchedModel& switched)
      : switched_(switched),
        state_(switched.state),
        stops_(equations::listRigidStops(switched.system.elements)),
        frictions_(equations::listSticking(switched.system.elements)) {
    const equations::ModelMotion<Symbol> motion = switched.calcMotion(state_);
    held_ = motion.held;
    touches_ = equations::calcTouches(switched.system, state_, motion);
  }

  RecordedEvents record() {
    RecordedEvents events;
    Behind behind{state_.coordinates, state_.speeds, recordStart()};
    const Symbol is_start = equal(switched_.event, Symbol(0.0));
    for (std::size_t i = 0; i < behind.modes.size(); ++i) {
      behind.modes[i] = select(is_start, behind.modes[i], state_.modes[i]);
    }
    for (int k = 0; k < countAll(); ++k) {
      const bool is_stop = k < countStops();
      events.guards.push_back(is_stop ? recordStopGuard(k) : recordFrictionGuard(k));
      events.dips.push_back(is_stop ? select(equal(state_.modes[k], Symbol(1.0)), Symbol(1.0), calcGap(k))
                                    : events.guards.back());
      choose(equal(switched_.event, Symbol(1.0 + k)), is_stop ? recordImpact(k) : recordFriction(k), behind);
    }
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      const int k = countAll() + static_cast<int>(i);
      events.guards.push_back(recordTouchGuard(k, touches_[i]));
      const Symbol &depth = touches_[i].depth, inside = equal(state_.modes[k], Symbol(1.0));
      events.dips.push_back(select(inside, depth, -depth));
      Behind toggled{state_.coordinates, state_.speeds, state_.modes};
      toggled.modes[k] = 1.0 - state_.modes[k];
      choose(equal(switched_.event, Symbol(1.0 + k)), toggled, behind);
    }
    append(behind.coordinates, events.transitions);
    append(behind.speeds, events.transitions);
    append(state_.states, events.transitions);
    append(behind.modes, events.transitions);
    append(switched_.hidden, events.transitions);
    return events;
  }

 private:
  int countStops() const { return static_cast<int>(stops_.size()); }
  /// But touches, which stand behind these.
  int countAll() const { return countStops() + static_cast<int>(frictions_.size()); }
  const Friction<Symbol>& getFriction(int k) const { return *frictions_[k - countStops()]; }
  Pair getPair(int k) const { return k < countStops() ? Pair(*stops_[k]) : Pair(getFriction(k)); }

  static void append(const Symbols& more, Symbols& symbols) {
    symbols.insert(symbols.end(), more.begin(), more.end());
  }
  static void choose(const Symbol& chosen, const Behind& one, Behind& other) {
    for (std::size_t i = 0; i < one.coordinates.size(); ++i) {
      other.coordinates[i] = select(chosen, one.coordinates[i], other.coordinates[i]);
    }
    for (std::size_t i = 0; i < one.speeds.size(); ++i) {
      other.speeds[i] = select(chosen, one.speeds[i], other.speeds[i]);
    }
    for (std::size_t i = 0; i < one.modes.size(); ++i) {
      other.modes[i] = select(chosen, one.modes[i], other.modes[i]);
    }
  }

  /// Until it is apart and goes away, or is in and goes deeper.
  Symbol recordTouchGuard(int k, const Touch& touch) const {
    return select(equal(state_.modes[k], Symbol(1.0)), max(touch.depth, touch.rate),
                  max(-touch.depth, -touch.rate));
  }

  /// A coordinate that takes forces has its rate among the speeds.
  Symbol calcSliding(int k, const Symbols& speeds) const {
    const Symbol rate = getPair(k).of(speeds);
    if (k < countStops() || !getFriction(k).surface_speed) {
      return rate;
    }
    return rate - *getFriction(k).surface_speed;
  }
  /// Positive away from the stop.
  Symbol orient(int k, const Symbol& value) const { return stops_[k]->above ? -value : value; }
  Symbol calcGap(int k) const { return calcStopGap(*stops_[k], getPair(k).of(state_.coordinates)); }

  /// Modes at the start: what touches its stop without speed rests, what does not slide sticks; where forces
  /// do not let it, the guard says so at once.
  Symbols recordStart() const {
    Symbols modes;
    for (int k = 0; k < countStops(); ++k) {
      const Symbol place = getPair(k).of(state_.coordinates), gap = calcGap(k);
      const Symbol touches = lessOrEqual(abs(gap), kEqualTo * (abs(place) + abs(place + orient(k, -gap))));
      modes.push_back(both(touches, equal(calcSliding(k, state_.speeds), Symbol(0.0))));
    }
    for (int k = countStops(); k < countAll(); ++k) {
      const Symbol speed = calcSliding(k, state_.speeds), rate = getPair(k).of(state_.speeds);
      const Symbol slides = less(kEqualTo * abs(rate), abs(speed));
      modes.push_back(select(slides, calcSide(speed), Symbol(0.0)));
    }
    for (const Touch& touch : touches_) {
      modes.push_back(less(Symbol(0.0), touch.depth));
    }
    return modes;
  }

  /// What friction on the same coordinate holds cannot move into the stop.
  Symbol recordStopGuard(int k) const {
    const Symbol free = max(calcGap(k), orient(k, calcSliding(k, state_.speeds)));
    const Symbol rests = orient(k, held_[k]) + std::numeric_limits<double>::min();  // no force does not lift
    Symbol guard = select(equal(state_.modes[k], Symbol(1.0)), rests, free);
    for (int j = countStops(); j < countAll(); ++j) {
      if (getPair(j) == getPair(k)) {
        const Symbol sticks = both(equal(state_.modes[j], Symbol(0.0)), equal(state_.modes[k], Symbol(0.0)));
        guard = select(sticks, Symbol(1.0), guard);
      }
    }
    return guard;
  }

  Symbol recordFrictionGuard(int k) const {
    const Symbol speed = calcSliding(k, state_.speeds), &mode = state_.modes[k];
    const Symbol left = switched_.calcLevel(getStaticLevel(getFriction(k))) - abs(held_[k]);
    return select(equal(mode, Symbol(1.0)), speed, select(equal(mode, Symbol(-1.0)), -speed, left));
  }

  /// The speeds behind an impulse along a switch's coordinates, and the modes that this leaves: friction that
  /// the impulse moves slides, and what it lifts off another stop is free.
  Behind strike(int k, const Symbol& change, const Symbol& mode, bool halts) const {
    Behind behind{state_.coordinates, state_.speeds, state_.modes};
    const Symbols impulse = equations::calcImpulse(switched_.system, state_, getPair(k), change);
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      behind.speeds[i] += impulse[i];
    }
    for (int j = 0; j < countAll(); ++j) {
      const Symbol moves = less(kEqualTo * abs(change), abs(getPair(j).of(impulse)));
      const Symbol side = halts && getPair(j) == getPair(k) && !hasSurfaceSpeed(j)
                              ? Symbol(0.0)
                              : calcSide(calcSliding(j, behind.speeds));
      behind.modes[j] = select(moves, j < countStops() ? Symbol(0.0) : side, state_.modes[j]);
    }
    behind.modes[k] = mode;
    return behind;
  }
  bool hasSurfaceSpeed(int k) const { return k >= countStops() && getFriction(k).surface_speed.has_value(); }

  /// Exactly at a stop, where the event was found but for rounding: a spring that is relaxed there then
  /// pushes to neither side.
  Symbols placeAt(int k) const {
    Symbols coordinates = state_.coordinates;
    coordinates[getPair(k).coordinate] = coordinates[getPair(k).coordinate] - orient(k, calcGap(k));
    return coordinates;
  }

  Behind recordImpact(int k) const {
    const Symbol speed = calcSliding(k, state_.speeds), &restitution = *stops_[k]->restitution;
    Behind behind = strike(k, -(1.0 + restitution) * speed, 0.0, false);
    ModelState<Symbol> flying = state_;
    flying.coordinates = placeAt(k);
    flying.speeds = behind.speeds;
    flying.modes = behind.modes;
    const Symbol fall = -orient(k, getPair(k).of(switched_.calcMotion(flying).accelerations));
    const Symbol back = -restitution * orient(k, speed);
    const Symbol rests = lessOrEqual(2.0 * back, kShortestFlight * switched_.duration * fall);
    Behind resting = strike(k, -speed, 1.0, true);
    resting.coordinates = flying.coordinates;
    choose(rests, resting, behind);
    Behind leaving{state_.coordinates, state_.speeds, state_.modes};
    leaving.modes[k] = 0.0;
    choose(equal(state_.modes[k], Symbol(1.0)), leaving, behind);
    return behind;
  }

  /// What slid to a halt slides on if its friction, which then opposes that, does not keep it from it. This
  /// needs no force that would hold it, which is infinite where a loop is at a dead centre and moves it
  /// nonetheless.
  Behind recordFriction(int k) const {
    const Symbol none(0.0), onwards = calcAcceleration(k, 1.0), backwards = calcAcceleration(k, -1.0);
    const Symbol halted =
        select(less(none, onwards), Symbol(1.0), select(less(backwards, none), Symbol(-1.0), none));
    Behind behind{state_.coordinates, state_.speeds, state_.modes};
    behind.modes[k] = select(notEqual(state_.modes[k], none), halted, -calcSide(held_[k]));
    return behind;
  }

  /// In another mode.
  Symbol calcAcceleration(int k, double mode) const {
    ModelState<Symbol> other = state_;
    other.modes[k] = mode;
    return getPair(k).of(switched_.calcMotion(other).accelerations);
  }

  const SwitchedModel& switched_;
  const ModelState<Symbol>& state_;
  const std::vector<const Stop<Symbol>*> stops_;
  const std::vector<const Friction<Symbol>*> frictions_;
  Symbols held_;
  std::vector<Touch> touches_;
};

}  // namespace

RecordedEvents recordEvents(const SwitchedModel& switched) {
  return EventRecorder(switched).record();
}

}  // namespace twinmap
