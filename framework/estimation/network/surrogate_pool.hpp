#pragma once

#include <cstdint>

#include "framework/estimation/network/noisy_samples.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"

namespace twinmap {

/// Points of the sampled box and what a surrogate says that a measurement there gives.
struct SurrogatePool {
  Eigen::MatrixXd points;           ///< m x n, in their units
  Eigen::VectorXd center;           ///< d
  Eigen::MatrixXd projection;       ///< k x d, from features to inputs of unit variance
  NormalInputs inputs;              ///< with the surrogate's own error
  Eigen::MatrixXd left_out_points;  ///< m x s, of the surrogate's simulations, in their units
  /// What they give where the surrogate is as wrong about them as it was when they were left out.
  NormalInputs left_out;
};

/// n draws of the prior. The inputs are the principal components of the noisy scores that stand above
/// the noise, and the known inputs. The result does not depend on the threads. Throws gp::Stopped. Cost: n
/// evaluations of the surrogate's processes and their variance. The surrogate's processes must know what they
/// left out (gp::SharedProcess::getLeftOut()), as those just fitted do.
SurrogatePool makeSurrogatePool(const Surrogate& surrogate, const ModelSpec& model, Eigen::Index n,
                                std::uint64_t seed, const TrainingControl& control);

}  // namespace twinmap
