#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "kernels/gp/marginal_likelihood.hpp"

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

/// One local search for the least objective (plus prior) by NLopt's L-BFGS, from `start` clamped into the
/// box, until a step gains less than `tolerance` nats, or, with the result of another search as `known`,
/// until it has come so near that it can only end in the same optimum. `samples`, their number, sets the
/// objective's size. Returns the best point evaluated. Deterministic.
SearchResult minimize(const Objective& objective, Eigen::Index samples, const Eigen::VectorXd& start,
                      const SearchBox& box, int max_evaluations, double tolerance,
                      const SearchResult* known = nullptr);

/// The same for the exact NLML. Cost: up to max_evaluations of n^3 flops.
SearchResult search(const TrainingSet& set, const Eigen::VectorXd& target, const Eigen::VectorXd& start,
                    const SearchBox& box, int max_evaluations, double tolerance,
                    LikelihoodWorkspace& workspace, const SearchResult* known = nullptr);

}  // namespace twinmap::gp
