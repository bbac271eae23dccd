#pragma once

#include <Eigen/Core>

#include "framework/design/random.hpp"
#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/response_layout.hpp"

namespace twinmap {

/// The noise's standard deviation of every row of a response, scale included.
Eigen::VectorXd calcNoiseStddev(const NoiseSpec& noise, const ResponseLayout& layout);

/// Responses (rows x n) plus independent normal noise. The noise of a response depends on the stream, its
/// column, its row and the replicate alone.
Eigen::MatrixXd addNoise(const Eigen::MatrixXd& responses, const Eigen::VectorXd& row_stddev,
                         const RandomStream& random, int replicate = 0);

}  // namespace twinmap
