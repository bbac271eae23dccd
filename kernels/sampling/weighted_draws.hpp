#pragma once

#include <Eigen/Core>

namespace twinmap::importance {

/// Points that stand for a distribution, each as much as its weight.
struct WeightedDraws {
  Eigen::MatrixXd points;   ///< u x n
  Eigen::VectorXd weights;  ///< n, sum 1; NaN where all were impossible
};

/// Weights proportional to exp(log_weights) (n): -infinity is impossible and weighs 0.
WeightedDraws weigh(Eigen::MatrixXd points, const Eigen::VectorXd& log_weights);

/// With an effective sample size below it, a mean is known to a tenth of a standard deviation at best.
constexpr double kSmallestSampleSize = 100.0;

/// (sum w)^2 / sum w^2: as many independent draws would tell the mean as well (Kong 1992). NaN where all were
/// impossible.
double calcEffectiveSampleSize(const WeightedDraws& draws);

Eigen::VectorXd calcMean(const WeightedDraws& draws);        ///< u
Eigen::MatrixXd calcCovariance(const WeightedDraws& draws);  ///< u x u

/// Quantiles of each variable (u x k) at probabilities (k, in [0, 1]): linear between the sorted points, each
/// at the middle of its weight. Cost: u n log n.
Eigen::MatrixXd calcQuantiles(const WeightedDraws& draws, const Eigen::VectorXd& probabilities);

/// n draws of equal weight (u x n), point i that in whose share of the weights uniforms[i], in (0, 1), lies:
/// independent where the uniforms are. Cost: n log n.
Eigen::MatrixXd resample(const WeightedDraws& draws, const Eigen::VectorXd& uniforms);

/// Weights to that power in (0, 1], the largest by bisection with which the effective sample size is at least
/// `least`: where few draws bear all the weight, their neighbours tell where to look too. Of logarithms (n),
/// for most of such draws have no weight that a double can hold; impossible ones (-infinity) stay so. Where
/// fewer than `least` are possible, these are about equal.
WeightedDraws temper(const Eigen::MatrixXd& points, const Eigen::VectorXd& log_weights, double least);

/// Shape k of the generalised Pareto distribution of the largest weights, a fifth of all but at most
/// 3 sqrt(n), by Zhang and Stephens (2009), drawn to 0.5 as ten weights would (Vehtari, Simpson, Gelman, Yao
/// and Gabry 2024). Above 0.7 the mean is not to be believed: what bears the weight was hardly drawn. Bounded
/// weights have k <= 0. NaN for fewer than 25 weights above 0. Cost: n log n.
double calcParetoShape(const WeightedDraws& draws);

}  // namespace twinmap::importance
