#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/diagnosis_step.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/diagnosis/term_sets.hpp"

namespace twinmap {

/// Adds terms to a model that does not explain its recordings, a step after the other.
class TermSearch {
 public:
  /// first: without any term, `shared` parameters of the machine; is_explained: whether that explains the
  /// recordings. `recordings` and `options` must outlive the object.
  TermSearch(const RecordedFeatures& recordings, const DiagnosisOptions& options, CurrentFit first,
             bool is_explained, Eigen::Index shared);

  /// The candidates on top of what was found before, and the one or two taken, if any. number: of steps that
  /// found some. Throws std::runtime_error if no fit with an accepted term succeeds, ExperimentError if it is
  /// no candidate. Cost: one simulation with derivatives a recording, and up to some ten fits.
  DiagnosisStep takeStep(std::size_t number);

  /// Without a term, then after each step that found some.
  const std::vector<CurrentFit>& getFits() const { return fits_; }
  /// Of each such step what the recordings do not tell from its fit: one term in the place of another.
  const std::vector<std::vector<AlternativeFit>>& getAlternatives() const { return alternatives_; }

 private:
  /// Fits the first `count`; those that are sought, not accepted, come in the order of what that says.
  void rankByFits(const CurrentFit& current, const ScoredCandidates& scored, std::size_t count,
                  std::vector<RankedTerm>& ranked) const;
  /// Scores all candidates once more where the best one fits, without it: there the linear model is near the
  /// truth. Fits the best of them from there; what ends better takes its place.
  void fitAgain(const CurrentFit& current, const ScoredCandidates& scored,
                std::vector<RankedTerm>& ranked) const;
  void takeFirst(const CurrentFit& current, const std::vector<RankedTerm>& ranked, DiagnosisStep& step);
  void takePair(const FittedPair& pair, DiagnosisStep& step);
  std::optional<FittedPair> findBetterPair(const CurrentFit& current, const ScoredCandidates& scored,
                                           const RankedTerm* single) const;
  std::size_t countSignificant(const std::vector<RankedTerm>& ranked) const;
  void setTied(const CurrentFit& current, const std::vector<RankedTerm>& ranked, DiagnosisStep& step) const;

  const RecordedFeatures& recordings_;
  const DiagnosisOptions& options_;
  std::vector<CurrentFit> fits_;
  std::vector<std::vector<AlternativeFit>> alternatives_;
  const bool is_explained_;
  const Eigen::Index shared_;
};

}  // namespace twinmap
