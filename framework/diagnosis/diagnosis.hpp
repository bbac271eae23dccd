#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/diagnosis_step.hpp"
#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/diagnosis/remainder/remainder.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"

namespace twinmap {

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
  double level = kMismatchLevel;  ///< DiagnosisOptions::level
  std::size_t shared = 0;         ///< parameters of the machine before any term, the first of `corrected`
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
  /// A process in the place of all terms that were found, where it has more evidence or ties with them. Wind
  /// and a drive's chatter are such.
  std::optional<Remainder> process;
  bool process_ties = false;  ///< whether the recordings do not tell it from the terms (kTiedEvidence)
  /// Whether `after` counts the colours that the noise of recordings has, which explain all where no term
  /// does.
  bool is_coloured = false;
  std::vector<RecordingInference> alone{};  ///< each as inference explains it, where it was asked

  /// Parameters whose best value before any term is within a hundredth of their bounds' width from a bound;
  /// none where the noise explains the recordings.
  std::vector<std::string> listAtBounds() const;
  /// Parameters of found terms that fit best beyond their bounds (findBeyondBounds).
  std::vector<std::string> listTermsAtBounds() const;

  /// Whether something is left unexplained, or a random force explains more than the terms that were found.
  bool isIncomplete() const { return !after.isExplained() || (process && !process_ties); }
  /// "model_incomplete" where it is, "noise_coloured" where that explains all. "unreliable" where the terms
  /// explain all, but no posterior with them is to be believed; else "ok".
  const char* getStatus() const;

  /// The names of the terms.
  std::vector<std::string> listTerms() const;

  /// Of listRecordingFaults(), those that the diagnosis has taken: no candidate stands for them.
  std::vector<std::string> listFaults() const;
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

/// The same of recordings as inference explains each alone (Diagnosis::alone).
Diagnosis diagnoseExplained(const ExperimentSpec& experiment, const DiagnosedRecordings& recordings,
                            const DiagnosisOptions& options);

}  // namespace twinmap
