#pragma once

#include <Eigen/Core>
#include <memory>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/marginal_likelihood.hpp"

namespace twinmap::gp {

/// The process with given hyperparameters, fitted to one target (length n). Throws std::invalid_argument on
/// bad input, std::runtime_error if the covariance matrix is not positive definite even with jitter. Cost:
/// n^3 / 3 flops, shared by `threads` threads; the result does not depend on their number.
std::shared_ptr<const GaussianProcess> fit(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                           const Eigen::Ref<const Eigen::VectorXd>& target,
                                           const ModelStructure& structure,
                                           const Hyperparameters& hyperparameters, int threads = 1);

/// The fitted process from what a successful evaluate_likelihood left in the workspace.
std::shared_ptr<const GaussianProcess> makeGaussianProcess(const TrainingSet& set,
                                                           const Hyperparameters& hyperparameters,
                                                           const LikelihoodEvaluation& evaluation,
                                                           const LikelihoodWorkspace& workspace);

}  // namespace twinmap::gp
