#pragma once

#include <vector>

#include "framework/estimation/ridges/combination.hpp"
#include "framework/estimation/ridges/flat_directions.hpp"

namespace twinmap {

/// Residual of a function that is exact, but for rounding.
constexpr double kExact = 1e-3;
/// Of the largest term, what a sum is not written without, and of a coefficient, what is not rounded away.
constexpr double kMattersInSum = 0.01;

/// A function that may be identified, and how complicated it is to read.
struct Candidate {
  Combination combination;
  double complexity = 0.0;
};

/// Products of powers of two to four parameters of the group whose residual is at most `largest`, one for
/// each ratio of exponents. Of more than 13 parameters no four are tried, of more than 18 no three. Negative
/// powers are of parameters whose bounds have one sign.
std::vector<Candidate> findProducts(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters,
                                    double largest);

/// Sums of two products of powers with the coefficients that fit best, likewise.
std::vector<Candidate> findSums(const FlatDirections& flat, const std::vector<ParameterSpec>& parameters,
                                double largest);

/// Base parameters, as identification of robots finds them by a rank-revealing factorisation of the regressor
/// (Gautier, 1991), here of the terms' derivatives along the flat directions: from the simplest term on, each
/// whose derivatives are a linear combination of those of independent terms before it makes, less that
/// combination, a sum that is identified. Of at most three terms.
std::vector<Candidate> findBaseParameters(const FlatDirections& flat,
                                          const std::vector<ParameterSpec>& parameters, double largest);

/// The root mean square sine of the angle between a combination's gradient and what is determined.
double calcResidual(const Combination& combination, const FlatDirections& flat,
                    const std::vector<ParameterSpec>& parameters);

/// Whether the value of a combination is the same at points that all fit one measurement. Allowed are three
/// times what is unknown of it, and a twentieth of what it would vary if its parameters varied as much, each
/// on its own. A gradient that is slightly off everywhere adds up along a long ridge.
bool isConstant(const Combination& combination, const FlatDirections& flat,
                const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
