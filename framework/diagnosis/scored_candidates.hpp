#pragma once

#include <memory>
#include <vector>

#include "framework/diagnosis/augment.hpp"
#include "framework/diagnosis/recorded_problem.hpp"
#include "framework/diagnosis/score_test.hpp"

namespace twinmap {

/// All candidates of an experiment with their scores at a point.
struct ScoredCandidates {
  std::vector<TermCandidate> candidates;
  std::vector<TermScore> scores;  ///< one each
  std::unique_ptr<ScoreTest> test;
  Eigen::VectorXd stddevs;  ///< u: of the unknown parameters, by the linear model and their bounds
  int tested = 0;           ///< those visible
};

/// point: u, of the unknown parameters (RecordingsProblem). Throws std::runtime_error where it cannot be
/// simulated. Cost: one simulation, one with derivatives a recording.
ScoredCandidates scoreCandidates(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                 const Eigen::VectorXd& point);

/// A model with the term at its best fit.
struct FittedTerm {
  AugmentedExperiment augmented;
  Eigen::VectorXd point;  ///< of its unknown parameters; empty where it cannot be simulated
  double chi_square = 0.0;
  double estimate = 0.0, stddev = 0.0;  ///< of the coefficient
  double cautious_stddev = 0.0;         ///< ScoreTest::calcCautiousStddev
  double log_evidence_of_scale = 0.0;   ///< what the freedom of an own scale costs, at most 0
};

/// Searches from `point` (u) without the term and with its score's estimate.
FittedTerm fitTerm(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const TermCandidate& candidate, const TermScore& score, const Eigen::VectorXd& point);

}  // namespace twinmap
