#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// How well one structure of a model explains recordings, and those that it is not fitted to.
struct StructureFit {
  double chi_square = 0.0, degrees = 0.0;
  double log_evidence = 0.0;  ///< of the recordings, up to what all structures have in common
  double held_out_rms = 0.0;  ///< in noise standard deviations
  double held_out_p = 1.0;    ///< of chi-square of what is predicted; the smallest where there are several
};

/// Evidence by Laplace's approximation: the recordings' likelihood at the best fit, times the share of the
/// bounds that the posterior takes. Comparable between experiments with the same recordings, features and
/// noise. Held out: each recording in turn, predicted by the others; of a single one, its last third in time
/// by what comes before. Throws std::runtime_error where nothing can be simulated. Cost: that of
/// samplePosterior(), once and for each recording again.
StructureFit calcStructureFit(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const SimulatorPosteriorOptions& options);

}  // namespace twinmap
