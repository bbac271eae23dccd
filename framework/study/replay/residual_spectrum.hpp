#pragma once

#include <Eigen/Core>

namespace twinmap {

/// Power of a residual by frequency, in units of white noise.
struct ResidualSpectrum {
  Eigen::VectorXd frequency;  ///< Hz, up to half of the mean rate
  Eigen::VectorXd power;  ///< |sum r_i exp(-2 pi i f t_i)|^2 / n: 1 on average of white noise of variance 1
};

/// Of a residual in standard deviations at increasing times (s, at least 4), its mean kept; at most 400
/// frequencies, equidistant. Cost: 400 n.
ResidualSpectrum calcResidualSpectrum(const Eigen::VectorXd& times, const Eigen::VectorXd& residual);

}  // namespace twinmap
