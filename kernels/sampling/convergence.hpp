#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap::markov {

/// What chains of one quantity say of how well they know it.
struct Convergence {
  double r_hat = 0.0;  ///< potential scale reduction: 1 where the chains agree; above 1.01 they do not
  double effective_sample_size = 0.0;  ///< independent draws that would tell the mean as well
};

/// Of chains (at least one, each of the same n >= 4 draws), each split in two halves, so that a drift shows:
/// R-hat is the root of the pooled over the mean within variance, the effective sample size m n over the
/// integrated autocorrelation time, by Geyer's initial monotone sequence over all chains (Gelman et al.,
/// Bayesian Data Analysis, 3rd ed., 11.4-11.5; Vehtari et al., Bayesian Analysis 16, 2021, without ranks).
/// NaN where all draws are equal. Cost: n flops a lag and chain.
Convergence calcConvergence(const std::vector<Eigen::VectorXd>& chains);

}  // namespace twinmap::markov
