#pragma once

#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/diagnosis/problem/score_test.hpp"

namespace twinmap {

/// So many times what its score estimates, or its standard deviation, a coefficient may be: far enough for a
/// fit of which the linear model says too little.
constexpr double kAboveScore = 10.0;

/// A model with the term at its best fit.
struct FittedTerm {
  AugmentedExperiment augmented;
  Eigen::VectorXd point;  ///< of its unknown parameters; empty where it cannot be simulated
  double chi_square = 0.0;
  double estimate = 0.0, stddev = 0.0;  ///< of the coefficient
  double cautious_stddev = 0.0;         ///< ScoreTest::calcCautiousStddev
  double log_evidence_of_scales = 0.0;  ///< what the freedom of own scales costs, at most 0
};

/// The derivatives with what is known of a term's own scales before any recording, as further residuals:
/// their priors are uniform in the logarithm. first: column of its coefficient, before those of its scales.
LinearizedRecordings addScalePriors(const LinearizedRecordings& linear, Eigen::Index first,
                                    const TermCandidate& candidate, const Eigen::VectorXd& point);

/// What the freedom of a term's own scales costs in evidence, at most 0. linear: with addScalePriors().
double calcScalesEvidence(const LinearizedRecordings& linear, Eigen::Index first,
                          const TermCandidate& candidate, const Eigen::VectorXd& point);

/// Searches from `point` (u) without the term and with its score's estimate.
FittedTerm fitTerm(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const TermCandidate& candidate, const TermScore& score, const Eigen::VectorXd& point);

}  // namespace twinmap
