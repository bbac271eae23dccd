#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/diagnosis/diagnosis_step.hpp"
#include "framework/diagnosis/fitted_term.hpp"
#include "framework/diagnosis/scored_candidates.hpp"

namespace twinmap {

/// An experiment, its terms, and where it fits the recordings best.
struct CurrentFit {
  ExperimentSpec experiment;
  Eigen::VectorXd point;
  double chi_square = 0.0, degrees = 0.0;
  std::vector<FoundTerm> terms{};
};

/// A finding with what fitted it.
struct RankedTerm {
  TermFinding finding;
  std::size_t index = 0;  ///< of the candidate and its score
  FittedTerm fitted{};
};

/// Terms that the recordings do not tell from those that were taken.
struct AlternativeFit {
  ExperimentSpec experiment;
  Eigen::VectorXd point;
  double log_evidence = 0.0;  ///< against those taken
};

/// The terms, the best first, each at the best of its own scales. What a scan costs in evidence is that the
/// other scales are not so good: their mean counts. p: parameters of the machine before any term.
std::vector<RankedTerm> rankTerms(const ScoredCandidates& scored, const CurrentFit& current, Eigen::Index p);

/// So many of the best by their scores are fitted where little is to be lost.
constexpr std::size_t kFittedOfBest = 3;
/// And so many of those that the linear model hardly tells from the best: the same terms on both sides of a
/// gear, say.
constexpr std::size_t kFittedAlike = 12;

bool hasMoreEvidence(const RankedTerm& a, const RankedTerm& b);

/// Fits a model with the term and says so in its finding; its evidence is -infinity where that fails.
void fitRanked(const CurrentFit& current, const RecordedFeatures& recordings, const ScoredCandidates& scored,
               Eigen::Index p, double level, RankedTerm& ranked);

/// The current fit with a term that was fitted.
CurrentFit addFitted(const CurrentFit& current, const RankedTerm& ranked);

/// log of what the sign of a coefficient has for it: friction that drives is rare. With even odds for the
/// others, 0.
double calcLogSignEvidence(const TermCandidate& candidate, double estimate);

/// Of the misfit beyond the degrees of freedom, what is gone.
double calcShare(double before, double after, double degrees);

}  // namespace twinmap
