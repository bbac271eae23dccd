#pragma once

#include <memory>
#include <variant>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// A trained process: exact, or sparse on inducing inputs.
using Process =
    std::variant<std::shared_ptr<const GaussianProcess>, std::shared_ptr<const SparseGaussianProcess>>;

}  // namespace twinmap::gp
