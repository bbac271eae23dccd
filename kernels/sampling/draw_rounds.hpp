#pragma once

#include <Eigen/Core>
#include <functional>

#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap::importance {

/// Draws of one proposal (u x n), and the logarithms of their weights (n).
struct Round {
  Eigen::MatrixXd points;
  Eigen::VectorXd log_weights;
};

/// Importance sampling by a proposal that stays as it is: rounds follow, as many as `most_rounds`, while the
/// effective sample size is below kSmallestSampleSize and as many rounds may reach it.
AdaptiveDraws drawInRounds(const std::function<Round(int round)>& draw, int most_rounds);

}  // namespace twinmap::importance
