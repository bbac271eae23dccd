#pragma once

#include <Eigen/Core>

#include "kernels/gp/optimizer.hpp"

namespace twinmap::gp {

/// The second derivatives of an objective (k x k, without the prior) at a point of the box, symmetric, by
/// differences of its gradient over 1e-3. Zero where the objective cannot be evaluated. Cost: k + 1
/// evaluations.
Eigen::MatrixXd calcCurvature(const Objective& objective, const Eigen::VectorXd& point, const SearchBox& box);

/// The same of the exact NLML of one target.
Eigen::MatrixXd calcCurvature(const TrainingSet& set, const Eigen::VectorXd& target,
                              const Hyperparameters& hyperparameters, const SearchBox& box,
                              LikelihoodWorkspace& workspace);

/// minimize() from near an optimum, where the curvature (k x k, symmetric) is known roughly: Newton's steps,
/// at most a factor of e in a hyperparameter, with what they see of the curvature (BFGS, damped as by Powell
/// 1978; hyperparameters at a bound that they press against stay there). Takes some 5 evaluations where
/// L-BFGS, which begins without the curvature, takes some 25. Ends where a step promises less than 1e-3 nats:
/// the likelihood itself tells hyperparameters to half a nat. Never ends above its start.
SearchResult polish(const Objective& objective, const Eigen::VectorXd& start,
                    const Eigen::MatrixXd& curvature, const SearchBox& box, const SearchLimits& limits);

}  // namespace twinmap::gp
