#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/analysis/least_squares.hpp"

namespace twinmap {

/// Mean and standard deviation of the parameters given one measurement, by simulation alone.
struct ExactPosterior {
  Eigen::VectorXd mean, stddev;        ///< p, in the parameters' units; NaN if not reliable
  double effective_sample_size = 0.0;  ///< (sum w)^2 / sum w^2 of the last round
  int simulations = 0;
  std::string warning;  ///< empty if reliable: found, and the effective sample size is at least 100
};

/// Importance sampling of the posterior under a uniform prior in the box and normal noise on the features:
/// the likelihood by simulation, the proposal a normal distribution, first Laplace's approximation at the
/// least-squares fit from `start`, widened by a quarter. `draws` points are a randomly shifted Sobol sequence
/// through the normal quantile. If the effective sample size is below a fifth of them, the proposal takes the
/// weighted mean and covariance, at most three times. `stream` keys the shift by (seed, sample).
/// Cost: draws simulations a round, besides the fit.
struct PosteriorOptions {
  int draws = 500;
  std::uint64_t seed = 1;
  int threads = 1;  ///< over measurements
};
ExactPosterior calcExactPosterior(Simulator& simulator, const LeastSquaresProblem& problem,
                                  const Eigen::VectorXd& start, int sample, const PosteriorOptions& options);

/// Measurements, one a column, whose posteriors are asked for.
struct PosteriorQuestions {
  Eigen::MatrixXd features;  ///< d x n, measured
  Eigen::MatrixXd starts;    ///< p x n, where the search for each begins
  Eigen::MatrixXd inputs;    ///< q x n, known; empty if there are none
};

/// The same for several measurements, on a team of threads; the result does not depend on their number.
std::vector<ExactPosterior> calcExactPosteriors(const Simulator& prototype, const FeatureExtractor& extractor,
                                                const NoiseWhitener& noise,
                                                const std::vector<ParameterSpec>& parameters,
                                                const PosteriorQuestions& questions,
                                                const PosteriorOptions& options);

}  // namespace twinmap
