#include "framework/diagnosis/missing_term.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/diagnosis/term_ranking.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The unknown parameters that explain a measurement best, as far as is known.
VectorXd findBest(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& unknown) {
  const auto u = static_cast<Index>(unknown.size());
  if (inferred.posterior && inferred.posterior->fit && inferred.posterior->fit->best.size() >= u) {
    return inferred.posterior->fit->best.head(u);  // before the sizes of a clock's faults
  }
  return inferred.explanation.size() >= u ? VectorXd(inferred.explanation.head(u)) : calcBoxCenter(unknown);
}

CurrentFit fitFrom(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                   const InferredMeasurement& inferred) {
  const RecordingsProblem problem(experiment, recording);
  const RecordingFit fit = problem.fit(findBest(inferred, problem.getUnknown()));
  const auto residuals = static_cast<double>(recording.features.front().array().isFinite().count());
  CurrentFit current{experiment, fit.point, fit.chi_square,
                     std::max(1.0, residuals - static_cast<double>(fit.point.size()))};
  if (hasUnknownNoise(experiment.noise) && fit.point.size() > 0) {
    const VectorXd residual = problem.linearize(fit.point).residual;
    current.experiment.noise =
        sizeNoise(experiment.noise, {experiment.noise, residual, current.degrees, problem.listInfos()},
                  recording.listOutputs(experiment));
    current.chi_square =
        RecordingsProblem(current.experiment, recording).linearize(fit.point).residual.squaredNorm();
  }
  return current;
}

std::optional<MissingTerm> findMissing(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                                       const InferredMeasurement& inferred) {
  constexpr double kLevel = 0.01;  // DiagnosisOptions::level
  constexpr std::size_t kFitted = 3;
  const CurrentFit current = fitFrom(experiment, recording, inferred);
  constexpr double kGross =
      1e4;  // chi-square a residual: a recording that the model is not about, or a wrong unit
  if (current.point.size() == 0 || current.chi_square > kGross * current.degrees) {
    return {};
  }
  const ScoredCandidates scored =
      scoreCandidates(current.experiment, recording, current.point, CandidateKinds::kWithoutStates);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  std::vector<RankedTerm> ranked = rankTerms(scored, current, p);
  ranked.resize(std::min(ranked.size(), kFitted), RankedTerm{{}});
  const RankedTerm* best = nullptr;
  for (RankedTerm& one : ranked) {
    if (one.finding.p_value < kLevel) {
      fitRanked(current, recording, scored, p, kLevel, one);
      best = one.finding.fitted && (best == nullptr || hasMoreEvidence(one, *best)) ? &one : best;
    }
  }
  if (best == nullptr || !(best->finding.log_evidence > 0.0)) {
    return {};
  }
  TermFinding found = best->finding;
  if (hasUnknownNoise(experiment.noise)) {
    found.share =
        1.0 - found.chi_square / current.chi_square;  // what is noise is not known: of the whole residual
  }
  return MissingTerm{
      found.candidate.term, found.candidate.meaning, found.candidate.unit, found.estimate, found.stddev,
      found.share,          found.log_evidence};
}

}  // namespace

std::optional<MissingTerm> findMissingTerm(const ExperimentSpec& experiment,
                                           const RecordedFeatures& recording,
                                           const InferredMeasurement& inferred) {
  if (!isGiven(experiment.model.system) || !(experiment.model.simulation.duration > 0.0)) {
    return {};
  }
  try {
    return findMissing(experiment, recording, inferred);
  } catch (const std::runtime_error&) {
    return {};  // the best fit cannot be simulated again: the inference's own statuses say what is wrong
  }
}

}  // namespace twinmap
