#pragma once

#include <Eigen/Core>
#include <functional>

#include "kernels/gp/stop.hpp"

namespace twinmap::markov {

/// The logarithm of a density, but for a summand, at a point (d); sets its gradient (d). Where it is not
/// finite the density is 0.
using LogDensity = std::function<double(const Eigen::VectorXd& point, Eigen::VectorXd& gradient)>;

/// The i-th of a chain's independent numbers.
struct ChainNumbers {
  std::function<double(Eigen::Index)> normal;   ///< standard normal
  std::function<double(Eigen::Index)> uniform;  ///< on (0, 1)
};

struct NutsOptions {
  int warm_up = 1000;       ///< steps in which step size and masses are found; they are not kept
  int draws = 1000;         ///< kept
  double acceptance = 0.8;  ///< mean acceptance that the step size is adapted to
  int deepest = 10;         ///< doublings of a trajectory at most
  gp::StopFlag stop = nullptr;
};

/// A chain of draws.
struct Chain {
  Eigen::MatrixXd draws;           ///< d x n
  double step_size = 0.0;          ///< after the warm-up
  Eigen::VectorXd inverse_masses;  ///< d, the variances that the warm-up found
  int divergences = 0;             ///< trajectories of kept draws whose energy ran away: regions are missed
  int cut = 0;                     ///< trajectories of kept draws that reached the deepest doubling
  double mean_acceptance = 0.0;
  Eigen::Index evaluations = 0;  ///< of the density
};

/// No-U-Turn sampling (Hoffman and Gelman, JMLR 15, 2014) with multinomial draws from each trajectory
/// (Betancourt 2017, arXiv 1701.02434, A.3.1): a Hamiltonian trajectory is doubled forwards or backwards
/// until it turns back, also where two of its halves meet. The step size is adapted by dual averaging, the
/// masses, a diagonal, by the variances of windows that double. One chain; the same bits for the same
/// numbers. Throws gp::Stopped, and std::invalid_argument where the density is 0 at the start. Cost: up to
/// 2^deepest densities a step.
Chain sampleNuts(const LogDensity& density, const Eigen::VectorXd& start, const ChainNumbers& numbers,
                 const NutsOptions& options);

}  // namespace twinmap::markov
