#pragma once

#include <Eigen/Core>
#include <optional>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/inference/simulator_sampler.hpp"

namespace twinmap {

/// How much noise of the input a residual shows.
struct InputNoise {
  double size = 0.0;        ///< over that of which the responses are
  double gain = 0.0;        ///< of -2 log likelihood, over none; of no noise chi-square of one degree
  double chi_square = 0.0;  ///< that is left with it
};

/// The likeliest size s of noise that adds s G n, n of unit variance, to a whitened residual (k) of which the
/// parameters take what they can: by restricted maximum likelihood of the linear model, its covariance 1 +
/// s^2 G G'. jacobian: k x u. responses: G, k x r. Sizes up to `largest` are tried. None where G is 0. Cost:
/// that of the eigenvalues of a k x k matrix.
std::optional<InputNoise> findInputNoise(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                                         const Eigen::MatrixXd& responses, double largest);

/// Rows of a linear model (k) in units of the noise that a fit found of their outputs.
void divideByFoundNoise(const LinearizedMeasurement& local, const FeatureExtractor& extractor,
                        const SimulatorFit& fit, Eigen::Ref<Eigen::MatrixXd> rows);

/// The size of noise, over that of which the responses (rows x r) are, that a fit shows: where it is
/// significant and leaves what the noise of the outputs explains; else 0.
double findNoiseSize(LinearizedMeasurement local, const FeatureExtractor& extractor,
                     const Eigen::MatrixXd& responses, const SimulatorFit& fit);

}  // namespace twinmap
