#pragma once

#include <memory>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// An exact process summarised by as many of its own inputs as its predictions need: the sparse process with
/// the same hyperparameters, its inducing inputs chosen by pivoted Cholesky factorisation until what they
/// leave undetermined at every training input is below `tolerance` times the noise variance. Smooth processes
/// with close samples need few: the cost and the memory of a prediction fall from n^2 to m^2. Null for a
/// process with a linear covariance term, which sparse processes do not have, or where more than n / 2 inputs
/// would be needed. Cost: 3 n m^2 flops. Memory: 8 n m bytes.
/// `storage`: what the inducing inputs are rounded to before all else follows from them.
enum class InputStorage { kDouble, kSingle };
std::shared_ptr<const SparseGaussianProcess> compress(const GaussianProcess& process, double tolerance,
                                                      InputStorage storage = InputStorage::kDouble);

}  // namespace twinmap::gp
