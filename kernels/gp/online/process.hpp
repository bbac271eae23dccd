#pragma once

#include <memory>
#include <variant>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// A trained process: exact, or sparse on inducing inputs.
using Process =
    std::variant<std::shared_ptr<const GaussianProcess>, std::shared_ptr<const SparseGaussianProcess>>;

/// The negative log marginal likelihood of a process, or the variational bound on it from above; nats.
double getNlml(const Process& process);

/// The variance of a process' noise, in squared target units.
double getNoiseVariance(const Process& process);

}  // namespace twinmap::gp
