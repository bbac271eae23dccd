#pragma once

#include <string>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/study/sweep/training_time.hpp"

namespace twinmap {

/// Times of one case, measured on one thread with some 300 simulations.
struct ProbeTimes {
  double simulation = 0.0;  ///< s, of one sample
  double stencil = 0.0;     ///< s, of simulating one; 0 where the simulator has derivatives
  TrainingTime training;
  double preparation = 0.0;  ///< s, for measurements, of one reference and training sample
  double limit = 0.0;        ///< s, of the information limit of one test sample, after its stencil
  double refinement = 0.0;   ///< s, of one test sample
  double evaluation = 0.0;   ///< s, of one test sample: its inference by the map, and its part of tables
  double overhead = 0.0;     ///< s, everything else: files, report, other evaluations
  double scores = 0.0;       ///< of a window of reduced samples, if they are
  std::string failure;       ///< why there are no times; empty if there are

  /// Preparing for measurements: a prediction per reference, which an exact process makes from all samples.
  double calcPreparation(const ExperimentSpec& experiment) const;
};

/// Runs small versions of an experiment in a temporary folder: the map alone with 60 training and 20 test
/// samples; all stages with up to 200 training samples, for their times; the map with 400 to 2000 test
/// samples, where there are more and they are cheap, for what grows with them; then with more noise draws and
/// few evaluations, to see how an evaluation of the marginal likelihood grows with the samples, up to
/// `most_samples` or 1000. Of a long record a few of the samples (thinSamples), whose times are multiplied.
ProbeTimes measureProbe(const ExperimentSpec& experiment, double most_samples);

}  // namespace twinmap
