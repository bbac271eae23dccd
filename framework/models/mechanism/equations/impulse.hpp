#pragma once

#include "framework/models/mechanism/equations/model_equations.hpp"

namespace twinmap::equations {

/// The change of all speeds by the impulse along a pair of coordinates that changes the pair's rate by
/// `change`: through the mass matrix, with the conditions of loops and prescribed motions kept, and without
/// what friction or other stops could add during it.
template <class S>
std::vector<S> calcImpulse(const SystemValues<S>& system, const ModelState<S>& state, const Pair& pair,
                           const S& change) {
  const int n = static_cast<int>(state.coordinates.size());
  const std::vector<BodyMotion<S>> motions = calcMotions(system, state.coordinates, state.speeds);
  LinearSystem<S> equations = calcEquationsOfMotion(system, motions, std::vector<Spatial<S>>(motions.size()),
                                                    std::vector<S>(n, S(0.0)));
  prescribe(state.prescribed, equations);
  std::vector<S> none;
  const Factors<S> mass = factorize(std::move(equations.matrix), kSingularPivot, none);
  const std::vector<S> row = pair.makeRow<S>(n);
  std::vector<S> column = solve(mass, row);
  if (const auto terms = calcClosureTerms(system, motions, state.coordinates); !terms.empty()) {
    const ClosureResponse<S> response = calcClosureResponse(mass, terms);
    std::vector<S> excess;
    for (const ClosureTerms<S>& term : terms) {
      excess.push_back(dotRow(term.row, column));
    }
    column = subtractResponse(response, solve(response.schur, std::move(excess)), std::move(column));
  }
  const S impulse = change / dotRow(row, column);
  for (S& speed : column) {
    speed = impulse * speed;
  }
  return column;
}

}  // namespace twinmap::equations
