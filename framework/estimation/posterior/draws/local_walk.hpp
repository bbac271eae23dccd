#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "framework/estimation/posterior/basins/misfit_surface.hpp"
#include "kernels/sampling/box_mixture.hpp"

namespace twinmap {

/// The posterior near points (u x n) as the response linearised there makes it, with a normal distribution
/// about each, of the covariance with the Cholesky factor `lower`, as its prior: as thin as the measurement
/// makes a valley, along it wherever it bends to. Points that cannot be simulated are left out. Cost: a
/// simulation with derivatives each.
std::vector<importance::NormalPart> linearizeAt(MisfitSurface& surface, const Eigen::MatrixXd& points,
                                                const Eigen::MatrixXd& lower);

/// Places of Markov chains of the posterior (u x n), of the second half of their steps: a chain from each
/// start (u x s), side by side. A step is drawn from the posterior of the response linearised where the chain
/// is, and accepted by Metropolis and Hastings' rule (the simplified manifold Langevin steps of Girolami and
/// Calderhead 2011, with the box in place of their step size), so that chains go round the bends of a valley
/// of any number of flat directions. Cost: a simulation with derivatives a step of each.
Eigen::MatrixXd walkPosterior(MisfitSurface& surface, const Eigen::MatrixXd& starts, int steps,
                              std::uint64_t seed);

}  // namespace twinmap
