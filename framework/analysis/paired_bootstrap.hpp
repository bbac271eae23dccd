#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "framework/analysis/jackknife.hpp"

namespace twinmap {

/// Samples whose figures depend on them through the means of per-sample terms alone.
struct TermSet {
  Eigen::MatrixXd terms;  ///< k x n, n >= 2
  FigureFunction figures;
};

struct BootstrapOptions {
  int resamples = 10000;
  double probability = 0.95;  ///< that the interval is meant to cover the difference
  std::uint64_t seed = 1;     ///< the same seed gives the same intervals, bit for bit
};

struct DifferenceIntervals {
  Eigen::VectorXd difference;    ///< figures of b minus figures of a
  Eigen::VectorXd lower, upper;  ///< of the interval; NaN where a figure is
};

/// Bootstrap confidence intervals of the differences of figures between two sets of the same samples: column
/// i of a and of b belong together and are drawn together, so that what is common to both cancels.
///
/// Intervals are bias-corrected and accelerated, BCa (Efron, Better bootstrap confidence intervals, JASA 82,
/// 1987): with the distribution G of the resampled difference, its bias z0 = Phi^-1(G(difference)) and the
/// acceleration a = sum u^3 / (6 (sum u^2)^1.5) from the jackknife's influences u,
///   limit(p) = G^-1(Phi(z0 + (z0 + z_p) / (1 - a (z0 + z_p)))).
/// Ties count half in G. Where all resamples agree the interval is that point.
///
/// Cost: O(resamples k n), memory O(k n + 64 n + resamples). Random numbers are counter-based.
DifferenceIntervals calcPairedIntervals(const TermSet& a, const TermSet& b,
                                        const BootstrapOptions& options = {});

/// The same between two independent sets, each resampled by itself (Davison and Hinkley, Bootstrap methods
/// and their application, 1997, eq. 5.23 for the acceleration).
DifferenceIntervals calcUnpairedIntervals(const TermSet& a, const TermSet& b,
                                          const BootstrapOptions& options = {});

}  // namespace twinmap
