#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// Whether e_k = a_1 e_{k-1} + ... + a_p e_{k-p} + w_k is stationary: the roots of z^p - a_1 z^{p-1} - ...
/// lie within the unit circle, by the reflection coefficients of Levinson's recursion taken backwards.
bool isStationary(const std::vector<double>& autoregression);

/// The autocorrelation at lags 0 .. lags of such a stationary process, by the Yule-Walker equations. Cost:
/// p^3 + p lags.
Eigen::VectorXd calcAutocorrelation(const std::vector<double>& autoregression, Eigen::Index lags);

/// Whether the Toeplitz matrix of an autocorrelation is positive definite, by Levinson and Durbin's
/// recursion. Cost: n^2.
bool isPositiveDefinite(const Eigen::VectorXd& autocorrelation);

/// Times in units of `sample_time` after the first, rounded; empty where one is not on that grid.
std::vector<long> findLags(const std::vector<double>& times, double sample_time);

}  // namespace twinmap
