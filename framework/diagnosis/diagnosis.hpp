#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/candidates/term_candidate.hpp"
#include "framework/diagnosis/recorded_problem.hpp"
#include "framework/diagnosis/remainder/remainder.hpp"
#include "framework/estimation/posterior/residual_test.hpp"

namespace twinmap {

/// What a diagnosis is held to.
struct DiagnosisOptions {
  /// Share of models without a fault for which a term is found (false discoveries).
  double level = 0.01;
  int max_terms = 3;
  /// Terms to take whatever the tests say, one after the other; then no others are sought.
  std::vector<std::string> accepted{};
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

/// How well an experiment explains the recordings, and what it says of the parameters.
struct ExplainedFit {
  SimulatorPosterior posterior;
  ResidualTest test;

  bool isExplained() const { return test.calcPValue() >= kMismatchLevel; }
};

/// The machine's parameters where terms are tied: the posteriors with each of them, weighted by their
/// evidence (Bayesian model averaging), as one says one thing of a parameter and one another.
struct AveragedEstimate {
  Eigen::VectorXd mean, stddev;  ///< p; empty where a posterior is not reliable
  Eigen::MatrixXd draws;         ///< p x n
  Eigen::VectorXd weights;       ///< n
  std::size_t models = 0;        ///< averaged over

  bool isGiven() const { return mean.size() > 0; }
  /// p x k, at probabilities (k).
  Eigen::MatrixXd calcQuantiles(const Eigen::VectorXd& probabilities) const;
};

struct Diagnosis {
  double level = 0.01;     ///< DiagnosisOptions::level
  std::size_t shared = 0;  ///< parameters of the machine before any term, the first of `corrected`
  ExplainedFit before;
  std::vector<DiagnosisStep>
      steps;                     ///< those that found a term, then the one that found none, if it was made
  std::size_t found = 0;         ///< of the steps, the first ones, that added terms to `corrected`
  std::vector<FoundTerm> terms;  ///< those of `corrected`, in their order
  ExperimentSpec corrected;      ///< with them, as further parameters
  NoiseSpec noise;               ///< of `corrected`, its unknown sizes as the residual has them
  AveragedEstimate averaged;     ///< over them and the terms that are tied with any of them
  ExplainedFit after;            ///< that of `corrected`; `before` where nothing was found
  /// What that leaves unexplained, as a process: where it does, and noise alone has less evidence.
  std::optional<Remainder> remainder;
  /// A process in the place of all terms that were found: where these leave something unexplained and it has
  /// more evidence than they have, as the random force of wind or of a drive's chatter would.
  std::optional<Remainder> process;

  /// Parameters whose best value before any term is within a hundredth of their bounds' width from a bound;
  /// none where the noise explains the recordings.
  std::vector<std::string> listAtBounds() const;

  /// Whether something is left unexplained, or a random force explains more than the terms that were found.
  bool isIncomplete() const { return !after.isExplained() || process; }
  /// "model_incomplete" where it is; "unreliable" where the terms explain all, but no posterior with them is
  /// to be believed; else "ok".
  const char* getStatus() const;

  /// The names of the terms.
  std::vector<std::string> listTerms() const;
};

/// Fits the experiment to the recordings (samplePosterior), tests each candidate by its score (ScoreTest)
/// with exact derivatives at the fit, fits the best ones, ranks them by their evidence, takes the first and
/// begins again with it. Two terms are taken at once where they explain what neither does, or more than the
/// first with any other. Terms that later ones make superfluous are dropped, and those that stood in for
/// others are exchanged (exchangeTerms). Ends where none is significant, after options.max_terms, or after
/// those accepted. Terms behind which something unexplained remains are kept only where they stand out of
/// that, too. Sizes of noise that are unknown are those of the residual, estimated again with what is
/// found until that stays. Throws ExperimentError as scoreCandidates() does and for an accepted term that is
/// not a candidate or that the parameters take up, std::runtime_error where nothing can be simulated. Cost:
/// two posteriors and one for each tied term; one or two simulations with derivatives for all candidates a
/// step, and some 40 to 80 for the fits.
Diagnosis diagnose(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const DiagnosisOptions& options);

}  // namespace twinmap
