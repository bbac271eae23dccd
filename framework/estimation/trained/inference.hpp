#pragma once

#include <Eigen/Core>

#include "framework/estimation/estimation_method.hpp"
#include "framework/estimation/interval_reach.hpp"
#include "framework/estimation/mixture.hpp"

namespace twinmap {

/// What is inferred from one measurement.
struct Inference {
  Eigen::VectorXd mean, stddev;  ///< p, in the parameters' units
  Eigen::VectorXd
      limit_stddev;  ///< p, what the measurement allows as the map predicts it; empty if it cannot
  Eigen::MatrixXd correlation{};  ///< p x p, of this measurement's errors, where the map tells; else empty
  Mixture mixture{};              ///< where the map gives one, whose mean and stddev are above
  IntervalReach reach{};          ///< of intervals, where they are not those of the distribution above
  EstimationMethod method{};      ///< the kind of the map
  Eigen::VectorXd inputs{};       ///< what the map sees of the features and known inputs, k
};

/// One answer that fits: mean and standard deviation, or those of the likeliest component.
struct LikeliestAnswer {
  Eigen::VectorXd mean, stddev;  ///< p
};

inline LikeliestAnswer findLikeliest(const Inference& inference) {
  if (!inference.mixture.isGiven()) {
    return {inference.mean, inference.stddev};
  }
  const Eigen::Index best = findLikeliest(inference.mixture);
  return {inference.mixture.means.col(best), inference.mixture.stddevs.col(best)};
}

}  // namespace twinmap
