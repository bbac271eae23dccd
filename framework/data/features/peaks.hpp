#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The top of a peak, between samples.
struct Peak {
  double position;  ///< in samples from the first
  double value;
};

/// The first `most` local maxima of equidistant values whose prominence is at least `prominence` and that
/// have fit_samples / 2 values on either side. Prominence: height above the higher of the two lowest values
/// that separate the maximum from something higher on its left and right, or from the end of the values (as
/// scipy.signal.peak_prominences). Position and value are those of the parabola that fits the `fit_samples`
/// (odd, 3 or more) values around the largest one by least squares. Values with NaN have no peaks.
/// Cost: O(n) for smooth values, O(n^2) at worst.
std::vector<Peak> findPeaks(const Eigen::VectorXd& values, double prominence, int fit_samples, int most);

}  // namespace twinmap
