#pragma once

#include <vector>

#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

/// Measured: one evaluation of the marginal likelihood with n samples, or the whole training of a surrogate,
/// takes so long on one thread.
struct EvaluationTime {
  double samples = 0.0;
  double seconds = 0.0;
};

/// What training takes, from measurements of small ones.
struct TrainingTime {
  std::vector<EvaluationTime> measured;  ///< by increasing samples, at least one
  double evaluations = 0.0;              ///< of one search on the first draw of the noise, for one parameter
  double evaluations_all = 0.0;          ///< of the search on all draws

  /// Between the measurements by a power law, above the last one by the cube, below the first one linear.
  double calcEvaluation(double samples) const;

  /// Seconds on one thread, all parameters and searches.
  double calcTraining(const ExperimentSpec& experiment) const;
};

}  // namespace twinmap
