#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {

/// What a diagnosis is held to.
struct DiagnosisOptions {
  /// Share of models without a fault for which a term is found (false discoveries).
  double level = kMismatchLevel;
  int max_terms = 3;
  /// Terms to take whatever the tests say, one after the other; then no others are sought.
  std::vector<std::string> accepted{};
  CandidateChoice candidates{};
  SimulatorPosteriorOptions posterior{};
};

/// What is known of a term that the model may lack.
struct TermFinding {
  TermCandidate candidate;  ///< its own scales as they were found
  double estimate = 0.0, stddev = 0.0;
  double z = 0.0;                 ///< of the score test, before any fit with the term
  double p_value = 1.0;           ///< of the largest of all |z| tested, where nothing is missing
  double log_evidence = 0.0;      ///< of the term against none (calcLogEvidence)
  double share = 0.0;             ///< of the misfit beyond the degrees of freedom that it explains, 0 to 1
  double chi_square = 0.0;        ///< with it
  bool fitted = false;            ///< whether by a fit with the term, or by the linear model
  bool holds_cautiously = false;  ///< whether it stands out of the residual that remains with it, too
  Eigen::VectorXd shifts{};       ///< p: how the machine's parameters move, in their sds without the term
};

/// A candidate in the place of a term of an earlier step, beside the terms found since.
struct TermRival {
  std::string term, rival;
  bool took_over = false;  ///< whether the term stood in for it; else they cannot be told apart
};

/// One term after the other: what may be missing beside those that were found before.
struct DiagnosisStep {
  double chi_square = 0.0, degrees = 0.0;  ///< before
  int tested = 0;                          ///< candidates that the parameters do not take up
  std::vector<TermFinding> ranked;         ///< the largest evidence first
  std::size_t tied = 1;                    ///< so many of the first cannot be told apart
  std::optional<TermFinding> partner{};    ///< of the first one: the two were found together
  std::vector<std::string> dropped{};      ///< terms of earlier steps that are superfluous with this one's
  std::vector<TermRival> rivals{};         ///< of terms of earlier steps
  std::string advice{};                    ///< which second test would, where they can be
  bool found = false;                      ///< whether the first one is missing
  double log_evidence = 0.0;               ///< of what was found against nothing more
};

/// A term of a model that was found, its coefficient and own scales the parameters from `first` on.
struct FoundTerm {
  TermCandidate candidate;
  Eigen::Index first = 0;
};

}  // namespace twinmap
