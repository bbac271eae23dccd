#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/gp/optimizer.hpp"
#include "kernels/gp/training_options.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap::gp {

/// One target, and its searches for the hyperparameters of least NLML.
struct TargetSearches {
  Eigen::VectorXd values;  ///< n
  double stddev = 0.0;
  bool constant = false;  ///< varies by no more than rounding: not searched
  SearchBox box;
  std::vector<Eigen::VectorXd> starts;  ///< log-hyperparameters
  Eigen::MatrixXd curvature;            ///< k x k, of a warm start, which is then the only one; else empty
  std::vector<SearchResult> results;    ///< one per start
  int warm_start_evaluations = 0;
};

/// Searches from several starts for each row of `targets` (t x n), parallel over targets x starts, or for
/// n > 1500 over the threads of one factorisation. The result does not depend on the number of threads.
/// The first start goes first; the others stop once they have joined its optimum. Throws Stopped.
std::vector<TargetSearches> searchAllStarts(const TrainingSet& set,
                                            const Eigen::Ref<const Eigen::MatrixXd>& targets,
                                            const TrainingOptions& options);

}  // namespace twinmap::gp
