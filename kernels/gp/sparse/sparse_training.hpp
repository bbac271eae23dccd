#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "kernels/gp/sparse/sparse_gaussian_process.hpp"
#include "kernels/gp/training.hpp"

namespace twinmap::gp {

struct SparseOptions {
  /// m. On 16000 two-beam samples, 500 do as well as an exact process on 4000 of them in a tenth of its time.
  int inducing = 500;
  /// Evenly spaced samples on which an exact process finds the hyperparameters. 1000: seconds, and within a
  /// few per cent of those of all samples.
  int subset = 1000;
  /// Evaluations that refine the hyperparameters on the bound over all samples, at 5 n m^2 flops each, in two
  /// rounds with the inducing inputs chosen anew between them; below 2 keeps those of the subset. 100: on the
  /// two-beam targets 40 left up to 80 nats of the bound, 200 gained less than one more.
  int refine_evaluations = 100;
};

struct SparseTrainingResult {
  TrainingStatus status = TrainingStatus::kFailed;
  std::string message;
  std::shared_ptr<const SparseGaussianProcess> gp;  ///< null where the status says so
  TrainingReport subset_report;                     ///< of the exact process on the subset
  double subset_bound = 0.0;                        ///< F over all samples at the subset's hyperparameters
  double bound = 0.0;                               ///< F at the final ones, nats
  int refine_evaluations = 0;
};

/// Trains one sparse process per row of `targets` (t x n): hyperparameters from an exact process on a subset,
/// inducing inputs by pivoted Cholesky, hyperparameters refined on the bound, the posterior over all samples.
/// Structures with a linear covariance term, and options out of range, are std::invalid_argument, as is what
/// train refuses. Results do not depend on the number of threads. Throws Stopped where the options ask for
/// it. Cost: train on the subset, then 5 n m^2 flops per refining evaluation; memory O(m^2 + m d) per thread.
std::vector<SparseTrainingResult> trainSparse(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                              const Eigen::Ref<const Eigen::MatrixXd>& targets,
                                              const ModelStructure& structure,
                                              const TrainingOptions& options = {},
                                              const SparseOptions& sparse = {});

}  // namespace twinmap::gp
