#pragma once

#include <Eigen/Core>

#include "framework/design/random.hpp"
#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// Each output's noise standard deviation, scale included, in the order of `outputs`.
Eigen::VectorXd collectNoiseStddev(const NoiseSpec& noise, const std::vector<OutputSpec>& outputs);

/// Responses (outputs * times x n, output by output) plus independent normal noise. The noise of a response
/// depends on the stream, its column, its row and the replicate alone.
Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const Eigen::VectorXd& stddev_of_output,
                         const RandomStream& random, int replicate = 0);

}  // namespace twinmap
