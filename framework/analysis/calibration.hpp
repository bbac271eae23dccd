#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/estimate.hpp"

namespace twinmap {

/// The value that a standard normal number is below with this probability, at least 1e-16 from 0 and 1.
double calcNormalQuantile(double probability);

/// Two-sided normal quantile: P(|z| < quantile) = probability, in (0, 1).
double calcTwoSidedQuantile(double probability);

/// Continuous ranked probability score of normal distributions, in the unit of stddev = s:
///   s (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi)),   z = (mean - true) / s
/// (Gneiting and Raftery, Strictly proper scoring rules, JASA 102, 2007, eq. 21, negated: less is better).
/// Where s goes to 0 it is the absolute error.
Eigen::ArrayXd calcCrps(const Eigen::ArrayXd& z, const Eigen::ArrayXd& stddev);

/// Probability integral transform Phi((true - mean) / stddev), or that of the mixture, of each parameter and
/// sample (p x n; of Estimates::repeated columns too): uniform on [0, 1] where the predictive distributions
/// are calibrated.
Eigen::MatrixXd calcPit(const Eigen::MatrixXd& truth, const Estimates& predictions);

constexpr int kPitBins = 10;

/// Counts of `pit` in kPitBins equal bins of [0, 1]. Flat: calibrated; a hump: stddev too large; a U: too
/// small; a slope: bias. Values that are not numbers are not counted. weights: of how many samples each
/// stands for (Estimates::weights), or empty; the counts are rounded.
std::vector<int> countPit(const Eigen::ArrayXd& pit, const Eigen::VectorXd& weights = {});

}  // namespace twinmap
