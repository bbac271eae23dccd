#pragma once

#include <Eigen/Core>

#include "framework/features/feature_extractor.hpp"
#include "framework/features/feature_noise.hpp"
#include "framework/simulation/simulator.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// What least squares on the simulator make of a point.
struct Refined {
  SampleStatus status;      ///< not ok: a simulation failed, and the point is the last good one
  Eigen::VectorXd point;    ///< of the sampled box
  Eigen::VectorXd stddev;   ///< of the searched parameters, from the Fisher information and the box
  double chi_square = 0.0;  ///< of the residual, in noise variances
  double distance = 0.0;    ///< from the first point, in standard deviations (Mahalanobis)
  int steps = 0;
  int simulations = 0;
  bool converged = false;  ///< the last step was below 0.1 standard deviations
};

/// The parameters that a refinement searches: `count` of the sampled box from `first` on; the others are
/// held.
struct SearchedParameters {
  Eigen::Index first = 0, count = 0;
};

/// At most `max_steps` Gauss-Newton steps on the noise-whitened features from `start` (a point of the sampled
/// box), halved where they do not improve, within the box. This is classical model updating from a start that
/// is already close. Cost: (2 u + 1) simulations a step, u the unknown parameters.
Refined refine(const ModelSpec& model, const Simulator& simulator, const FeatureExtractor& extractor,
               const FeatureNoise& noise, const Eigen::VectorXd& features, const Eigen::VectorXd& start,
               const SearchedParameters& searched, int max_steps = 5);

}  // namespace twinmap
