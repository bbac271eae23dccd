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

}  // namespace twinmap
