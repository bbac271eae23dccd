#pragma once

#include <memory>
#include <vector>

#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/diagnosis/problem/score_test.hpp"

namespace twinmap {

/// All candidates of an experiment with their scores at a point.
struct ScoredCandidates {
  std::vector<TermCandidate> candidates;
  std::vector<TermScore> scores;  ///< one each
  std::unique_ptr<ScoreTest> test;
  Eigen::VectorXd stddevs;  ///< u: of the unknown parameters, by the linear model and their bounds
  int tested = 0;           ///< those visible
};

/// Throws ExperimentError for a model that is not a system of bodies, or is not simulated in time.
void requireSystem(const ExperimentSpec& experiment);

/// Which candidates are scored: those with states take most of the time.
enum class CandidateKinds { kAll, kWithoutStates };

struct CandidateChoice {
  CandidateKinds kinds = CandidateKinds::kAll;
  /// Terms ("gain.x"), or all of a name ("gain"), beside which no others can be; empty: all can.
  std::vector<std::string> only{};
  std::vector<std::string> without{};  ///< those that cannot be
};

/// Throws ExperimentError for a name of the choice that no candidate has.
void requireCandidates(const CandidateChoice& choice, const ExperimentSpec& experiment,
                       const RecordedFeatures& recordings, const Eigen::VectorXd& point);

/// point: u, of the unknown parameters (RecordingsProblem). Throws ExperimentError as requireSystem() does,
/// std::runtime_error where the point cannot be simulated. Cost: one simulation, one with derivatives a
/// recording for all candidates without states, and one for each few of those with states.
ScoredCandidates scoreCandidates(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                 const Eigen::VectorXd& point, const CandidateChoice& choice = {});

/// So many times what its score estimates a coefficient may be: far enough for a fit of which the linear
/// model says too little.
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
