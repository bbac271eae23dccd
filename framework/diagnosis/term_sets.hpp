#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/term_ranking.hpp"

namespace twinmap {

/// Two terms of different kinds that are added together.
struct TermPair {
  std::size_t first = 0, second = 0;  ///< candidates
  ScoreTest::JointScore score;
  double log_evidence = -kInfinity;  ///< of both against none, by the linear model
  double p_value = 1.0;              ///< of the best of all pairs, where nothing is missing
};

/// The pair of the largest evidence by the linear model, its signs as physics has them; of those with the
/// candidate's term of `with`, if it is given. None where no two are distinct. Cost: k^2 (n + 10) flops.
std::optional<TermPair> findPair(const ScoredCandidates& scored, const std::string& with = "");

/// Two terms fitted together, the more significant one first, and what both have for them against none.
struct FittedPair {
  TermFinding first, second;
  CurrentFit fit;
  double log_evidence = 0.0;
};

/// None where that fails. p: parameters of the machine before any term; level: of what holds cautiously.
/// Cost: that of fitTerm().
std::optional<FittedPair> fitPair(const CurrentFit& current, const RecordedFeatures& recordings,
                                  const ScoredCandidates& scored, const TermPair& pair, Eigen::Index p,
                                  double level);

/// The fit without its term number `out`; no point where that fails. Cost: that of a fit.
CurrentFit fitWithout(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                      const CurrentFit& fit, std::size_t out);

/// Takes out each term but the last that the others have made superfluous: the fit without it has the larger
/// evidence. Returns the names of those taken out. Cost: one simulation with derivatives a recording, and a
/// fit for each term taken out.
std::vector<std::string> dropSuperfluous(const ExperimentSpec& without_terms,
                                         const RecordedFeatures& recordings, CurrentFit& fit);

}  // namespace twinmap
