#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/estimation/posterior/basin_search.hpp"

namespace twinmap {

/// A place where the posterior has some of its mass, apart from the others.
struct PosteriorMode {
  double weight = 0.0;           ///< share of the posterior
  Eigen::VectorXd mean;          ///< u, in the parameters' units
  Eigen::VectorXd stddev;        ///< u
  double chi_square = 0.0;       ///< at its minimum
  Eigen::MatrixXd covariance{};  ///< u x u
};

/// The posterior of the unknown parameters given one measurement, by simulation alone: normal noise, a prior
/// that is uniform within the bounds. u parameters in their units. Moments, quantiles and draws are there
/// only where it is reliable.
struct SimulatorPosterior {
  Eigen::VectorXd mean, stddev;            ///< u
  Eigen::MatrixXd covariance;              ///< u x u
  Eigen::MatrixXd draws;                   ///< u x n, weighted by `weights`
  Eigen::VectorXd weights;                 ///< n, sum 1
  Eigen::VectorXd best;                    ///< u, the least chi-square; there where anything was simulated
  std::vector<PosteriorMode> modes;        ///< the heaviest first
  Eigen::VectorXd residual;                ///< there, whitened
  double chi_square = 0.0, degrees = 0.0;  ///< of the best point; 0 degrees where nothing could be simulated
  double effective_sample_size = 0.0;
  double pareto_shape = 0.0;
  int starts = 0;       ///< searches for basins
  int found_best = 0;   ///< of them, those that ended in the best one
  int simulations = 0;  ///< those with derivatives count once
  std::string message;  ///< why it is not reliable; else empty

  bool isReliable() const { return message.empty(); }
  /// Whether noise explains the best point (calcChiSquareLimit).
  bool isExplained() const;
  /// Quantiles (u x k) at probabilities (k). Only where it is reliable.
  Eigen::MatrixXd calcQuantiles(const Eigen::VectorXd& probabilities) const;
};

struct SimulatorPosteriorOptions {
  int draws = 512;  ///< of a round; the error of a mean is then below a tenth of a standard deviation
  std::uint64_t seed = 1;
  BasinSearchOptions search{};
};

/// Finds every basin (findBasins), then samples all of them together (importance::sampleAdaptively) in
/// LogCoordinates, from a mixture of what the linear models in the basins say. Without a map or a surrogate.
/// features: d, finite; held: a point of the sampled box whose known inputs are kept; given: points of the
/// unknown parameters (u x n, within the bounds) to search from as well. The result depends on neither
/// threads nor other measurements. Cost: some 2000 simulations for the basins and `draws` a round.
SimulatorPosterior samplePosterior(Simulator& simulator, const RefinementModel& model,
                                   const Eigen::VectorXd& features, const Eigen::VectorXd& held,
                                   const Eigen::MatrixXd& given, const SimulatorPosteriorOptions& options);

}  // namespace twinmap
