#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace twinmap {

/// Simulation-based calibration (Talts, Betancourt, Simpson, Vehtari and Gelman 2018): how true values rank
/// among draws of the posteriors of as many measurements. Of q quantities.
struct RankCalibration {
  Eigen::MatrixXi counts;      ///< bins x q: measurements whose rank lies in that equal part of the ranks
  Eigen::VectorXd chi_square;  ///< q, of the counts against equal ones
  Eigen::VectorXd p_value;     ///< q: how often right posteriors have no smaller one
};

/// Draws of a posterior that a true value is ranked among: the ranks 0 to 199 fall into equal bins.
constexpr Eigen::Index kRankDraws = 199;
/// Fewer measurements leave fewer than five for each of ten bins, too few for a chi-square.
constexpr Eigen::Index kMinRanks = 50;

/// What distances of points are taken from, and in which metric: anything that the measurement alone tells,
/// such as a normal approximation. Moments of the draws would not do: draws are nearer to their own than the
/// truth is (in eight dimensions 9 % of the truths were farther than 95 % of them).
struct RankMetric {
  const Eigen::VectorXd& center;      ///< p
  const Eigen::MatrixXd& covariance;  ///< p x p
};

/// Ranks of one measurement's truth (p) among draws (p x at least kRankDraws, the first are taken): for each
/// quantity how many draws lie below it; and last, for all together, how many lie nearer by the metric.
Eigen::VectorXi calcRanks(const Eigen::Ref<const Eigen::VectorXd>& truth, const Eigen::MatrixXd& draws,
                          const RankMetric& metric);

/// Of ranks (q x n) in 0 to kRankDraws, n at least kMinRanks: twenty bins, or ten for fewer than 200
/// measurements.
RankCalibration calcRankCalibration(const Eigen::MatrixXi& ranks);

/// Those of q quantities whose ranks right posteriors would hardly have: with all of them right, one of a
/// thousand evaluations names any.
std::vector<Eigen::Index> findMiscalibrated(const RankCalibration& calibration);

}  // namespace twinmap
