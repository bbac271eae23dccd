#include "framework/diagnosis/best_term.hpp"

#include <algorithm>

#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

CurrentFit fitFrom(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const MatrixXd& starts) {
  const RecordingsProblem problem(experiment, recordings);
  const RecordingFit fit = problem.fit(starts);
  const auto residuals = static_cast<double>(problem.listInfos().size());
  CurrentFit current{experiment, fit.point, fit.chi_square,
                     std::max(1.0, residuals - static_cast<double>(fit.point.size()))};
  if (hasUnknownNoise(experiment.noise) && fit.point.size() > 0) {
    const VectorXd residual = problem.linearize(fit.point).residual;
    current.experiment.noise =
        sizeNoise(experiment.noise, {experiment.noise, residual, current.degrees, problem.listInfos()},
                  recordings.listOutputs(experiment));
    current.chi_square =
        RecordingsProblem(current.experiment, recordings).linearize(fit.point).residual.squaredNorm();
  }
  return current;
}

const RankedTerm* fitBest(const CurrentFit& current, const RecordedFeatures& recordings,
                          const ScoredCandidates& scored, Index p, std::vector<RankedTerm>& ranked) {
  ranked.resize(std::min(ranked.size(), kFittedOfBest), RankedTerm{{}});
  const RankedTerm* best = nullptr;
  for (RankedTerm& one : ranked) {
    if (one.finding.p_value < kMismatchLevel) {
      fitRanked(current, recordings, scored, p, kMismatchLevel, one);
      best = one.finding.fitted && (best == nullptr || hasMoreEvidence(one, *best)) ? &one : best;
    }
  }
  return best != nullptr && best->finding.log_evidence > 0.0 ? best : nullptr;
}

bool isTied(const RankedTerm& one, const RankedTerm& best) {
  return one.finding.fitted && best.finding.log_evidence - one.finding.log_evidence < kTiedEvidence;
}

bool explains(const CurrentFit& current, const RecordedFeatures& recordings, const FittedTerm& term) {
  const RecordingsProblem problem(term.augmented.experiment, recordings);
  const VectorXd residual = problem.linearize(term.point).residual;
  const double degrees = std::max(1.0, current.degrees - static_cast<double>(term.augmented.added));
  return testResidual(residual, degrees, problem.listInfos()).calcPValue() >= kMismatchLevel;
}

MissingTerm describeMissing(const RankedTerm& best, const std::vector<RankedTerm>& ranked,
                            double chi_square) {
  const TermFinding& found = best.finding;
  MissingTerm missing{
      found.candidate.term, found.candidate.meaning, found.candidate.unit, found.estimate, found.stddev,
      found.share,          found.log_evidence,      found.shifts};
  missing.share_of_all = 1.0 - found.chi_square / chi_square;
  for (const RankedTerm& one : ranked) {
    if (&one != &best && isTied(one, best)) {
      missing.rivals.push_back(one.finding.candidate.term);
    }
  }
  return missing;
}

}  // namespace twinmap
