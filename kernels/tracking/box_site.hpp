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
/// the bounds -1 and 1 cut off. What has to be taken out of them to leave that likelihood is found by
/// Newton's method from its natural parameters (the site of expectation propagation, Minka 2001). Nothing is
/// where the bounds are eight standard deviations away. All is where no likelihood explains so large a
/// variance. Cost: some 10 us.
BoxSite calcBoxSite(Eigen::Index parameter, double mean, double variance);

}  // namespace twinmap::tracking
