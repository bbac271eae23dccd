#pragma once

#include <Eigen/Core>

namespace twinmap::tracking {

/// The normal factor exp(-precision x^2 / 2 + shift x) that stands for the bounds of a uniform prior in an
/// estimate of one parameter.
struct BoxSite {
  Eigen::Index parameter = 0;
  double precision = 0.0, shift = 0.0;
};

/// Of an estimate in half-widths of its bounds. Its mean and variance are those of a normal likelihood that
/// the bounds -1 and 1 cut off. Newton's method finds the likelihood from its natural parameters; the rest is
/// the site (expectation propagation, Minka 2001). It is nothing where the bounds are eight standard
/// deviations away. It is all where no likelihood explains so large a variance. Cost: some 10 us.
BoxSite calcBoxSite(Eigen::Index parameter, double mean, double variance);

}  // namespace twinmap::tracking
