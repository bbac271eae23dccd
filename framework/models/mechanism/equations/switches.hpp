#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/constrained_motion.hpp"

namespace twinmap::equations {

// Elements that switch: rigid stops, friction that sticks, and what a damper meets at its first touch. Each
// has a mode, which is constant between events: a stop's 0 (free) or 1 (the coordinate rests on it), a
// friction's 0 (sticks), 1 or -1 (slides that way), a touch's 0 (apart) or 1; in this order, of touches those
// of stops first. What rests or sticks is held: the rate of a coordinate, or its difference to another's,
// stays as it is by a force that the equations of motion yield.

template <class S>
std::vector<const Stop<S>*> listRigidStops(const ForceElements<S>& elements) {
  std::vector<const Stop<S>*> stops;
  for (const Stop<S>& stop : elements.template get<Stop>()) {
    if (stop.isRigid()) {
      stops.push_back(&stop);
    }
  }
  return stops;
}

template <class S>
std::vector<const Friction<S>*> listSticking(const ForceElements<S>& elements) {
  std::vector<const Friction<S>*> frictions;
  for (const Friction<S>& friction : elements.template get<Friction>()) {
    if (friction.switches()) {
      frictions.push_back(&friction);
    }
  }
  return frictions;
}

/// Elements whose damper acts from the touch on, as they have modes.
template <class S>
struct Touching {
  std::vector<const Stop<S>*> stops;
  std::vector<const Contact<S>*> contacts;

  std::size_t count() const { return stops.size() + contacts.size(); }
};

template <class S>
Touching<S> listTouching(const ForceElements<S>& elements) {
  Touching<S> touching;
  for (const Stop<S>& stop : elements.template get<Stop>()) {
    if (stop.damping) {
      touching.stops.push_back(&stop);
    }
  }
  for (const Contact<S>& contact : elements.template get<Contact>()) {
    if (contact.damping) {
      touching.contacts.push_back(&contact);
    }
  }
  return touching;
}

template <class S>
int countSwitches(const ForceElements<S>& elements) {
  return static_cast<int>(listRigidStops(elements).size() + listSticking(elements).size() +
                          listTouching(elements).count());
}

/// A coordinate, or its difference to another.
struct Pair {
  int coordinate;
  std::optional<int> against;

  template <class Element>
  explicit Pair(const Element& element) : coordinate(element.coordinate), against(element.against) {}

  bool operator==(const Pair& other) const {
    return (coordinate == other.coordinate && against == other.against) ||
           (against == other.coordinate && other.against == coordinate);
  }
  /// Of values of all coordinates.
  template <class S>
  S of(const std::vector<S>& values) const {
    return against ? S(values[coordinate] - values[*against]) : values[coordinate];
  }
  template <class S>
  std::vector<S> makeRow(int coordinates) const {
    std::vector<S> row(coordinates, S(0.0));
    row[coordinate] = 1.0;
    if (against) {
      row[*against] = -1.0;
    }
    return row;
  }
};

/// What a switch holds while `active` is not 0.
template <class S>
struct Held {
  Pair pair;
  S active;
};

/// One for each switch, in the order of the modes. Friction on what rests on a stop holds nothing, since the
/// stop does.
template <class S>
std::vector<Held<S>> listHeld(const ForceElements<S>& elements, const std::vector<S>& modes) {
  using namespace program::real;
  std::vector<Held<S>> held;
  for (const Stop<S>* stop : listRigidStops(elements)) {
    held.push_back({Pair(*stop), equal(modes[held.size()], S(1.0))});
  }
  const std::size_t stops = held.size();
  for (const Friction<S>* friction : listSticking(elements)) {
    const Pair pair(*friction);
    S active = equal(modes[held.size()], S(0.0));
    for (std::size_t i = 0; i < stops; ++i) {
      if (held[i].pair == pair) {
        active = select(held[i].active, S(0.0), active);
      }
    }
    held.push_back({pair, active});
  }
  return held;
}

/// As solveConstrained() with what switches hold: each adds a row to the conditions, which is 1 = 1 while it
/// holds nothing. `forces` are those of the closures, then minus those of the switches.
template <class S>
ConstrainedMotion<S> solveHeld(LinearSystem<S> equations, std::vector<ClosureTerms<S>> conditions,
                               const std::vector<Prescribed<S>>& known, const std::vector<Held<S>>& held) {
  using namespace program::real;
  const int n = static_cast<int>(equations.right.size());
  std::vector<S> active(conditions.size(), S(1.0));
  for (const Held<S>& one : held) {
    conditions.push_back({S(0.0), S(0.0), one.pair.template makeRow<S>(n)});
    active.push_back(one.active);
  }
  prescribe(known, conditions);  // once more those of closures, which changes nothing
  const Factors<S> mass = factorize(std::move(equations.matrix), kSingularPivot, equations.right);
  std::vector<S> free = substitute(mass, std::move(equations.right)), excess;
  ClosureResponse<S> response;
  std::vector<std::vector<S>> schur;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    response.columns.push_back(solve(mass, conditions[k].row));
    excess.push_back(select(active[k], S(dotRow(conditions[k].row, free) + conditions[k].bias), S(0.0)));
    schur.emplace_back();
    for (std::size_t j = 0; j <= k; ++j) {
      const S both_hold = j == k ? active[k] : both(active[k], active[j]);
      schur.back().push_back(
          select(both_hold, dotRow(conditions[k].row, response.columns[j]), S(j == k ? 1.0 : 0.0)));
    }
  }
  std::vector<S> none;
  response.schur = factorize(std::move(schur), kSingularClosure, none);
  std::vector<S> held_back(excess.end() - static_cast<std::ptrdiff_t>(held.size()), excess.end());
  ConstrainedMotion<S> motion = holdConditions(mass, response, std::move(excess), std::move(free));
  motion.held_back = std::move(held_back);
  return motion;
}

}  // namespace twinmap::equations
