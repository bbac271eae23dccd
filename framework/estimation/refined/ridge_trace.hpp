#pragma once

#include <optional>

#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/mixture.hpp"
#include "framework/estimation/refined/misfit.hpp"

namespace twinmap {

/// The posterior along a ridge: values of the parameters that fit alike, one after the other.
struct RidgeTrace {
  Mixture pieces;           ///< of equal length along the ridge, in half-widths (s), at most 200
  Eigen::VectorXd mean;     ///< s, half-widths
  Eigen::VectorXd stddev;   ///< s, half-widths
  IntervalFactors factors;  ///< s x 1: intervals mean +- factor stddev have their probability
};

/// Whether the data leave one direction at the minimum to the box: half of the standard deviation that the
/// bounds allow.
bool hasFlatDirection(const LocalMisfit& minimum);

/// Follows the one flat direction from a minimum to the bounds on both sides, or to where the misfit has
/// risen by 25. The direction is the eigenvector of least information; a piece's place is found by
/// Gauss-Newton steps across it, so that a ridge may bend (m L = const) and is followed as a profile
/// likelihood is. Its weight is exp(-misfit / 2) over the square root of the determinant of the
/// information across: Laplace's approximation across, quadrature along, within the box and its prior.
/// Nothing where there is no flat direction or more than one, and where a simulation fails or the steps do
/// not converge. Cost: four linearisations of a straight ridge (a + b = const), one batch; of others two or
/// three a piece, some 16 pieces, eight at a time.
std::optional<RidgeTrace> traceRidge(Misfit& misfit, const LocalMisfit& minimum);

}  // namespace twinmap
