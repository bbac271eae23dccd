#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/noise/noise_hypothesis.hpp"

namespace twinmap {

/// Of an autoregression that noise may have.
constexpr int kMaxOrder = 3;

/// A series of residuals, and what may be fitted to it.
struct ResidualSeries {
  Eigen::VectorXd residual;  ///< n
  Eigen::MatrixXd
      regressors;          ///< n x u: derivatives of what is simulated by the unknown, an offset beside them
  std::vector<long> lags;  ///< n, in sample times, increasing
};

/// The colours that a series may have: nodes of a quadrature over autoregressions of one order.
///
/// The restricted likelihood (the regressors' coefficients and the size integrated out: Patterson and
/// Thompson 1971), which has not the bias of a residual's autocorrelation towards 0, times a density that is
/// uniform in the partial autocorrelations, is integrated over their inverse hyperbolic tangents
/// about its maximum, along its principal directions, each side with a width of its own: by 11 equidistant
/// nodes of one coefficient, 49 of two, Gauss's and Hermite's 27 of three. Their log_weight makes a sum over
/// them an integral. The order, up to three, is that of the least -2 log likelihood + p log n (BIC); empty
/// where that is 0. Cost: some 200 evaluations of n p u + n u^2 each order.
std::vector<NoiseColour> fitColours(const ResidualSeries& series);

}  // namespace twinmap
