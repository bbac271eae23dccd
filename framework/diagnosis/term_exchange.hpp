#pragma once

#include <string>
#include <vector>

#include "framework/diagnosis/term_ranking.hpp"

namespace twinmap {

/// What came of an exchange.
struct Exchange {
  std::vector<TermRival> rivals;
  std::vector<AlternativeFit> alternatives;  ///< with a rival in the place of one term
  bool took_over = false;                    ///< whether any rival did
};

/// Exchanges terms that were taken before others were known, and stand for some of what those explain. Each
/// is taken out, and all candidates are tested beside those that are left. The best one is put in where it
/// has clearly more evidence (kTiedEvidence) and explains no less. `count`: of the first terms, all but one
/// that was just chosen beside the others. p: parameters of the machine before any term. Cost: for each term
/// a fit without it, the scores of all candidates, and some four to seven fits.
Exchange exchangeTerms(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                       Eigen::Index p, const DiagnosisOptions& options, std::size_t count, CurrentFit& fit);

}  // namespace twinmap
