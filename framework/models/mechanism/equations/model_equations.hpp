#pragma once

#include <cassert>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/mechanism/equations/calc_system_values.hpp"
#include "framework/models/mechanism/equations/forces.hpp"

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

/// Applied forces, applied moments and force laws.
template <class S>
void addLoads(const SystemSpec& spec, const SystemNames& system, const NamedValues<S>& names,
              ForceSum<S>& sum) {
  const auto express = [&](const Expression3& components, ForceFrame frame, int body) {
    const Vec3<S> value = names.calc3(components);
    return frame == ForceFrame::kBody ? sum.motions[body].pose.rotation * value : value;
  };
  for (std::size_t i = 0; i < spec.applied_forces.size(); ++i) {
    const AppliedForceSpec& force = spec.applied_forces[i];
    const StationValues<S>& station = sum.system.loaded[i];
    const Vec3<S> arm = sum.motions[station.body].pose.rotation * station.point;
    sum.addAt(station.body, arm, express(force.force, force.frame, station.body));
  }
  for (const AppliedMomentSpec& moment : spec.applied_moments) {
    const int body = system.findBody(moment.body);
    sum.addMoment(body, express(moment.moment, moment.frame, body));
  }
  for (const ForceLawSpec& law : spec.force_laws) {
    sum.addOnCoordinate(system.findCoordinate(law.coordinate), names.calc(law.force));
  }
}

/// The equations of motion of a model. `names`: its parameters and constants, `values`: calcSystemValues of
/// them.
template <class S>
ModelMotion<S> calcModelMotion(const ModelSpec& model, const SystemNames& system, const NamedValues<S>& names,
                               const SystemValues<S>& values, const ModelState<S>& state) {
  ModelMotion<S> motion;
  motion.rates = calcRates(values, state.coordinates, state.speeds);
  motion.bodies = calcMotions(values, state.coordinates, state.speeds);
  ForceSum<S> sum(values, motion.bodies);
  addPassiveForces(state.coordinates, motion.rates, sum);
  addLoads(model.system, system, nameState(model, system, state, motion.rates, names), sum);
  Solution<S> solution = solve(calcEquationsOfMotion(values, motion.bodies, sum.on_bodies, sum.on_speeds));
  motion.accelerations = std::move(solution.values);
  motion.pivots = std::move(solution.pivots);
  return motion;
}

}  // namespace twinmap::equations
