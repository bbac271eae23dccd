#pragma once

#include <cassert>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/mechanism/equations/calc_system_values.hpp"
#include "framework/models/mechanism/equations/gravity_force.hpp"
#include "framework/models/mechanism/equations/switches.hpp"
#include "framework/models/mechanism/varying_expressions.hpp"

namespace twinmap::equations {

/// A model's state over a scalar, in the order of SystemNames: coordinates, speeds as Simbody has them, and
/// states of first order.
template <class S>
struct ModelState {
  S time = 0.0;
  std::vector<S> coordinates, speeds, states{};
  std::vector<S> signals{};       ///< of the excitation
  std::vector<S> signal_rates{};  ///< as nameSignalRates() has them, of the orders that expressions use
  std::vector<Prescribed<S>> prescribed{};
  std::vector<S> modes{};  ///< of switches (switches.hpp); empty: none, and what switches exerts nothing
};

/// What follows from a state.
template <class S>
struct ModelMotion {
  std::vector<S> rates;          ///< time derivatives of the coordinates
  std::vector<S> accelerations;  ///< of the speeds
  std::vector<S> state_rates;
  std::vector<S> pivots;  ///< all positive, or the mass matrix or a loop is singular
  std::vector<BodyMotion<S>> bodies;
  std::vector<Spatial<S>> loads;  ///< on bodies: gravity and force elements
  std::vector<S> closure_forces;  ///< of the conditions: they act as -G' times these
  std::vector<S> held{};          ///< forces with which switches hold their coordinates
  std::vector<S> held_back{};     ///< accelerations that they take away
  std::vector<S> driving{};       ///< forces on their coordinates that prescribed motions take
};

/// How deep something is pressed in, and how fast that grows.
template <class S>
struct TouchMotion {
  S depth, rate;
};

/// Of what touches with a damper, in the order of the modes.
template <class S>
std::vector<TouchMotion<S>> calcTouches(const SystemValues<S>& system, const ModelState<S>& state,
                                        const ModelMotion<S>& motion) {
  std::vector<TouchMotion<S>> touches;
  const Touching<S> touching = listTouching(system.elements);
  for (const Stop<S>* stop : touching.stops) {
    const Pair pair(*stop);
    const S rate = pair.of(motion.rates);
    touches.push_back({S(-calcStopGap(*stop, pair.of(state.coordinates))), stop->above ? rate : S(-rate)});
  }
  for (const Contact<S>* contact : touching.contacts) {
    const PlaneMotion<S> at = calcOnPlane(motion.bodies, contact->station, contact->plane);
    touches.push_back({at.depth, at.rate});
  }
  return touches;
}

/// The forces of gravity on coordinates that take forces (<coordinate>_gravity), unless something else has
/// the name.
template <class S>
void nameGravity(const SystemNames& system, const SystemValues<S>& values,
                 const std::vector<BodyMotion<S>>& motions, NamedValues<S>& names) {
  for (std::size_t i = 0; i < system.getCoordinates().size(); ++i) {
    const std::string name = system.getCoordinateNames()[i] + kGravitySuffix;
    if (system.getCoordinates()[i].traits.takes_forces && !names.contains(name)) {
      names.define(name, calcGravityForce(values, motions, system.getCoordinates()[i]));
    }
  }
}

/// The values that expressions of a state may use. `names`: parameters and constants; `values` of them.
template <class S>
NamedValues<S> nameState(const ModelSpec& model, const SystemNames& system, const SystemValues<S>& values,
                         const std::vector<BodyMotion<S>>& motions, const ModelState<S>& state,
                         const std::vector<S>& rates, NamedValues<S> names) {
  const std::vector<std::string>& coordinates = system.getCoordinateNames();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    names.set(coordinates[i], state.coordinates[i]);
    names.set(coordinates[i] + "_dot", rates[i]);
  }
  for (std::size_t i = 0; i < model.excitation.size(); ++i) {
    names.set(model.excitation[i].name.text, state.signals[i]);
  }
  names.set("t", state.time);
  const std::vector<std::string> signal_rates = nameSignalRates(model.excitation, 2);
  for (std::size_t i = 0; i < state.signal_rates.size(); ++i) {
    if (!names.contains(signal_rates[i])) {
      names.define(signal_rates[i], state.signal_rates[i]);
    }
  }
  if (mayUseGravity(model)) {
    nameGravity(system, values, motions, names);
  }
  for (std::size_t i = 0; i < state.states.size(); ++i) {
    names.set(system.getStateNames()[i], state.states[i]);
  }
  for (const NamedExpression& named : model.system.expressions) {
    names.set(named.name.text, names.calc(named.value));
  }
  return names;
}

/// Gravity and all force elements, and the rates of all states. `named`: parameters, constants and the state.
template <class S, class Named>
Loads<S> calcLoads(const SystemSpec& spec, const SystemValues<S>& values,
                   const std::vector<BodyMotion<S>>& motions, const ModelState<S>& state,
                   const std::vector<S>& rates, const Named& named) {
  Loads<S> loads = makeLoads<S>(motions.size(), state.coordinates.size(), state.states.size());
  ForceSum<S, Named> sum(motions, state.coordinates, rates, state.states, named, loads, &state.modes);
  for (std::size_t i = 1; i < motions.size(); ++i) {
    sum.addGravity(static_cast<int>(i), values.gravity, values.bodies[i].mass, values.bodies[i].center);
  }
  setStateRates(spec.states, named, loads);
  addElementForces(values.elements, sum);
  return loads;
}

/// Takes known accelerations out of the equations, whose matrix has its lower triangle alone: what they
/// exert on the other rows goes to the right, and their own rows say what they are.
template <class S>
void prescribe(const std::vector<Prescribed<S>>& known, LinearSystem<S>& equations) {
  const int n = static_cast<int>(equations.right.size());
  for (const Prescribed<S>& one : known) {
    const int p = one.coordinate;
    for (int i = 0; i < n; ++i) {
      S& coupling = i < p ? equations.matrix[p][i] : equations.matrix[i][p];
      equations.right[i] = equations.right[i] - coupling * one.acceleration;
      coupling = S(i == p ? 1.0 : 0.0);
    }
    equations.right[p] = one.acceleration;
  }
}

/// What motions take: their rows of M u' + G' l - f, before known accelerations are taken out of them.
template <class S>
std::vector<S> calcDriving(const std::vector<Prescribed<S>>& known, const LinearSystem<S>& equations,
                           const std::vector<ClosureTerms<S>>& closures, const ModelMotion<S>& motion) {
  std::vector<S> forces;
  for (const Prescribed<S>& one : known) {
    const int p = one.coordinate;
    S force = -equations.right[p];
    for (int i = 0; i < static_cast<int>(equations.right.size()); ++i) {
      force = force + (i < p ? equations.matrix[p][i] : equations.matrix[i][p]) * motion.accelerations[i];
    }
    for (std::size_t k = 0; k < closures.size(); ++k) {
      force = force + closures[k].row[p] * motion.closure_forces[k];
    }
    forces.push_back(force);
  }
  return forces;
}

/// The equations of motion of a model. `names`: its parameters and constants, `values`: calcSystemValues of
/// them.
template <class S>
ModelMotion<S> calcModelMotion(const ModelSpec& model, const SystemNames& system, const NamedValues<S>& names,
                               const SystemValues<S>& values, const ModelState<S>& state) {
  ModelMotion<S> motion;
  motion.rates = calcRates(values, state.coordinates, state.speeds);
  motion.bodies = calcMotions(values, state.coordinates, state.speeds);
  Loads<S> loads = calcLoads(model.system, values, motion.bodies, state, motion.rates,
                             nameState(model, system, values, motion.bodies, state, motion.rates, names));
  motion.state_rates = std::move(loads.state_rates);
  LinearSystem<S> equations =
      calcEquationsOfMotion(values, motion.bodies, loads.on_bodies, std::move(loads.on_speeds));
  std::vector<ClosureTerms<S>> closures = calcClosureTerms(values, motion.bodies, state.coordinates);
  const std::size_t closure_count = closures.size();
  const bool is_driven = !state.prescribed.empty();
  const LinearSystem<S> all = is_driven ? equations : LinearSystem<S>{};
  const std::vector<ClosureTerms<S>> all_closures = is_driven ? closures : std::vector<ClosureTerms<S>>{};
  prescribe(state.prescribed, equations);
  prescribe(state.prescribed, closures);
  ConstrainedMotion<S> solution = state.modes.empty()
                                      ? solveConstrained(std::move(equations), closures)
                                      : solveHeld(std::move(equations), std::move(closures), state.prescribed,
                                                  listHeld(values.elements, state.modes));
  const auto first_held = solution.forces.begin() + static_cast<std::ptrdiff_t>(closure_count);
  for (auto force = first_held; force != solution.forces.end(); ++force) {
    motion.held.push_back(-*force);
  }
  solution.forces.erase(first_held, solution.forces.end());
  motion.held_back = std::move(solution.held_back);
  motion.loads = std::move(loads.on_bodies);
  motion.closure_forces = std::move(solution.forces);
  motion.accelerations = std::move(solution.accelerations);
  motion.pivots = std::move(solution.pivots);
  motion.driving = calcDriving(state.prescribed, all, all_closures, motion);
  return motion;
}

}  // namespace twinmap::equations
