#pragma once

#include <cassert>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/mechanism/equations/calc_system_values.hpp"
#include "framework/models/mechanism/equations/force_sum.hpp"

namespace twinmap::equations {

/// A model's state over a scalar, in the order of SystemNames: coordinates, and speeds as Simbody has them.
template <class S>
struct ModelState {
  S time = 0.0;
  std::vector<S> coordinates, speeds;
  std::vector<S> signals;  ///< of the excitation
};

/// What follows from a state.
template <class S>
struct ModelMotion {
  std::vector<S> rates;          ///< time derivatives of the coordinates
  std::vector<S> accelerations;  ///< of the speeds
  std::vector<S> pivots;         ///< all positive, or the mass matrix is singular
  std::vector<BodyMotion<S>> bodies;
};

/// The values that forces by expression may use.
template <class S>
NamedValues<S> nameState(const ModelSpec& model, const SystemNames& system, const ModelState<S>& state,
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
  return names;
}

/// Gravity and all force elements. `named`: parameters, constants and the state.
template <class S, class Named>
Loads<S> calcLoads(const SystemValues<S>& values, const std::vector<BodyMotion<S>>& motions,
                   const std::vector<S>& coordinates, const std::vector<S>& rates, const Named& named) {
  Loads<S> loads{std::vector<Spatial<S>>(motions.size()), std::vector<S>(coordinates.size(), S(0.0))};
  ForceSum<S, Named> sum(motions, coordinates, rates, named, loads);
  for (std::size_t i = 1; i < motions.size(); ++i) {
    sum.addGravity(static_cast<int>(i), values.gravity, values.bodies[i].mass, values.bodies[i].center);
  }
  addElementForces(values.elements, sum);
  return loads;
}

/// The equations of motion of a model. `names`: its parameters and constants, `values`: calcSystemValues of
/// them.
template <class S>
ModelMotion<S> calcModelMotion(const ModelSpec& model, const SystemNames& system, const NamedValues<S>& names,
                               const SystemValues<S>& values, const ModelState<S>& state) {
  ModelMotion<S> motion;
  motion.rates = calcRates(values, state.coordinates, state.speeds);
  motion.bodies = calcMotions(values, state.coordinates, state.speeds);
  Loads<S> loads = calcLoads(values, motion.bodies, state.coordinates, motion.rates,
                             nameState(model, system, state, motion.rates, names));
  Solution<S> solution =
      solve(calcEquationsOfMotion(values, motion.bodies, loads.on_bodies, std::move(loads.on_speeds)));
  motion.accelerations = std::move(solution.values);
  motion.pivots = std::move(solution.pivots);
  return motion;
}

}  // namespace twinmap::equations
