#pragma once

#include <utility>
#include <vector>

#include "framework/models/mechanism/equations/closures.hpp"

namespace twinmap::equations {

/// A pivot of G M^-1 G' below this part of its diagonal entry is a singular configuration: the directions in
/// which two conditions act differ by less than 1e-5 rad, and their forces are larger by as much.
constexpr double kSingularClosure = 1e-10;

template <class S>
S dotRow(const std::vector<S>& row, const std::vector<S>& speeds) {
  S sum = 0.0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    sum = sum + row[i] * speeds[i];
  }
  return sum;
}

/// The conditions' rows G with M^-1 G' and the factors of G M^-1 G' (Schur's complement of the mass matrix):
/// what a change of motion along each condition does to all of them.
template <class S>
struct ClosureResponse {
  std::vector<std::vector<S>> columns;  ///< of M^-1 G', one a condition
  Factors<S> schur;
};

template <class S>
ClosureResponse<S> calcClosureResponse(const Factors<S>& mass, const std::vector<ClosureTerms<S>>& closures) {
  ClosureResponse<S> response;
  std::vector<std::vector<S>> schur;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    response.columns.push_back(solve(mass, closures[k].row));
    schur.emplace_back();
    for (std::size_t j = 0; j <= k; ++j) {
      schur.back().push_back(dotRow(closures[k].row, response.columns[j]));
    }
  }
  std::vector<S> none;
  response.schur = factorize(std::move(schur), kSingularClosure, none);
  return response;
}

/// values - M^-1 G' forces
template <class S>
std::vector<S> subtractResponse(const ClosureResponse<S>& response, const std::vector<S>& forces,
                                std::vector<S> values) {
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = values[i] - forces[k] * response.columns[k][i];
    }
  }
  return values;
}

template <class S>
struct ConstrainedMotion {
  std::vector<S> accelerations;
  std::vector<S> forces;       ///< of the conditions: M u' = f - G' forces
  std::vector<S> pivots;       ///< of the mass matrix, then of the conditions
  std::vector<S> held_back{};  ///< of solveHeld(): the acceleration that each switch takes away; 0 of others
};

/// A coordinate whose acceleration is known.
template <class S>
struct Prescribed {
  int coordinate;
  S acceleration;
};

/// What known accelerations do to conditions becomes part of their bias, and their forces do not act on those
/// coordinates.
template <class S>
void prescribe(const std::vector<Prescribed<S>>& known, std::vector<ClosureTerms<S>>& closures) {
  for (ClosureTerms<S>& closure : closures) {
    for (const Prescribed<S>& one : known) {
      S& slope = closure.row[one.coordinate];
      closure.bias = closure.bias + slope * one.acceleration;
      slope = S(0.0);
    }
  }
}

/// By the excess that free accelerations leave of the conditions.
template <class S>
ConstrainedMotion<S> holdConditions(const Factors<S>& mass, const ClosureResponse<S>& response,
                                    std::vector<S> excess, std::vector<S> free) {
  ConstrainedMotion<S> motion;
  motion.forces = solve(response.schur, std::move(excess));
  motion.accelerations = subtractResponse(response, motion.forces, std::move(free));
  motion.pivots = mass.pivots;
  motion.pivots.insert(motion.pivots.end(), response.schur.pivots.begin(), response.schur.pivots.end());
  return motion;
}

/// M u' + G' l = f and G u' + bias = 0, by elimination of u'.
template <class S>
ConstrainedMotion<S> solveConstrained(LinearSystem<S> equations,
                                      const std::vector<ClosureTerms<S>>& closures) {
  const Factors<S> mass = factorize(std::move(equations.matrix), kSingularPivot, equations.right);
  std::vector<S> free = substitute(mass, std::move(equations.right));
  if (closures.empty()) {
    return {std::move(free), {}, mass.pivots};
  }
  const ClosureResponse<S> response = calcClosureResponse(mass, closures);
  std::vector<S> excess;
  for (const ClosureTerms<S>& closure : closures) {
    excess.push_back(dotRow(closure.row, free) + closure.bias);
  }
  return holdConditions(mass, response, std::move(excess), std::move(free));
}

/// Couples a coordinate to no other: its row and column of the mass matrix, of which the lower triangle is
/// there, become those of the unit matrix.
template <class S>
void hold(int coordinate, std::vector<std::vector<S>>& matrix) {
  for (int i = 0; i < static_cast<int>(matrix.size()); ++i) {
    (i < coordinate ? matrix[coordinate][i] : matrix[i][coordinate]) = S(i == coordinate ? 1.0 : 0.0);
  }
}

/// Coordinates and speeds that satisfy the conditions, nearest in the metric of the mass matrix: by `rounds`
/// steps of Newton's method, first for the coordinates, then for the speeds, all with the derivatives at the
/// state that is given. A distance d from the conditions becomes d^(1 + rounds) over a length^rounds. What is
/// `held` does not move.
template <class S>
std::pair<std::vector<S>, std::vector<S>> project(const SystemValues<S>& system,
                                                  const std::vector<S>& coordinates, std::vector<S> speeds,
                                                  int rounds, const std::vector<int>& held = {}) {
  std::vector<BodyMotion<S>> motions = calcMotions(system, coordinates, speeds);
  std::vector<ClosureTerms<S>> terms = calcClosureTerms(system, motions, coordinates);
  LinearSystem<S> equations = calcEquationsOfMotion(system, motions, std::vector<Spatial<S>>(motions.size()),
                                                    std::vector<S>(coordinates.size(), S(0.0)));
  std::vector<ClosureTerms<S>> acting = terms;
  for (const int coordinate : held) {
    hold(coordinate, equations.matrix);
    for (ClosureTerms<S>& closure : acting) {
      closure.row[coordinate] = S(0.0);
    }
  }
  const Factors<S> mass = factorize(std::move(equations.matrix), kSingularPivot, equations.right);
  const ClosureResponse<S> response = calcClosureResponse(mass, acting);
  std::vector<S> closed = coordinates;
  for (int round = 0; round < rounds; ++round) {
    std::vector<S> distances;
    for (const ClosureTerms<S>& term : terms) {
      distances.push_back(term.value);
    }
    const std::vector<S> change =
        calcRates(system, coordinates,
                  subtractResponse(response, solve(response.schur, std::move(distances)),
                                   std::vector<S>(speeds.size(), S(0.0))));
    for (std::size_t i = 0; i < closed.size(); ++i) {
      closed[i] = closed[i] + change[i];
    }
    terms = calcClosureTerms(system, calcMotions(system, closed, speeds), closed);
  }
  for (int round = 0; round < rounds; ++round) {
    std::vector<S> rates;
    for (const ClosureTerms<S>& term : terms) {
      rates.push_back(dotRow(term.row, speeds));
    }
    speeds = subtractResponse(response, solve(response.schur, std::move(rates)), std::move(speeds));
  }
  return {std::move(closed), std::move(speeds)};
}

}  // namespace twinmap::equations
