#pragma once

#include <memory>
#include <variant>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/sparse/sparse_gaussian_process.hpp"

namespace twinmap {

/// One parameter's process: exact, or sparse on inducing inputs.
using Process = std::variant<std::shared_ptr<const gp::GaussianProcess>,
                             std::shared_ptr<const gp::SparseGaussianProcess>>;

/// Its negative log marginal likelihood, or the variational bound on it from above; nats.
double getNlml(const Process& process);

/// Its likelihood's noise variance, in the standardised parameter.
double getNoiseVariance(const Process& process);

}  // namespace twinmap
