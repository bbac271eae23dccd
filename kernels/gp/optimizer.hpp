#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "kernels/gp/marginal_likelihood.hpp"
#include "kernels/gp/stop.hpp"

namespace twinmap::gp {

/// Where a search may go, and from where; all in log-hyperparameters.
struct SearchBox {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  /// A normal prior on each log-hyperparameter; precision 0 means none.
  Eigen::VectorXd prior_mean;
  Eigen::VectorXd prior_precision;
};

struct SearchResult {
  Eigen::VectorXd end;
  double nlml = 0.0;
  double objective = 0.0;  ///< +infinity if no evaluation succeeded
  int evaluations = 0;
  double largest_jitter = 0.0;
  bool converged = false;
  std::string stop_reason;
};

/// What is minimised, and its gradient at a point, both without the prior.
using Objective =
    std::function<LikelihoodEvaluation(const Eigen::VectorXd& point, Eigen::VectorXd& gradient)>;

/// What ends a search besides an optimum.
struct SearchLimits {
  int max_evaluations = 200;
  double tolerance = 1e-6;  ///< nats; a step that gains less ends the search
  /// The result of another search: once so near it that only the same optimum can follow, the search ends.
  const SearchResult* known = nullptr;
  StopFlag stop = nullptr;  ///< once true, nothing more is evaluated
};

/// One local search for the least objective (plus prior) by NLopt's L-BFGS, from `start` clamped into the
/// box. `samples`, their number, sets the objective's size. Returns the best point evaluated. Deterministic
/// unless it is stopped.
SearchResult minimize(const Objective& objective, Eigen::Index samples, const Eigen::VectorXd& start,
                      const SearchBox& box, const SearchLimits& limits);

/// minimize() for the exact NLML of one target. Cost: up to limits.max_evaluations of n^3 flops.
SearchResult search(const TrainingSet& set, const Eigen::VectorXd& target, const Eigen::VectorXd& start,
                    const SearchBox& box, const SearchLimits& limits, LikelihoodWorkspace& workspace);

}  // namespace twinmap::gp
