#include "framework/diagnosis/term_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

TermFinding makeFinding(const ScoredCandidates& scored, std::size_t i, const CurrentFit& current, Index p) {
  TermFinding finding{scored.candidates[i]};
  const TermScore& score = scored.scores[i];
  finding.estimate = score.estimate;
  finding.stddev = score.stddev;
  finding.z = score.z;
  finding.p_value = calcPValue(score.z, scored.tested);
  finding.log_evidence =
      calcLogEvidence(score.z * score.z, {score.estimate, score.stddev, finding.candidate.size}) +
      calcLogSignEvidence(finding.candidate, score.estimate);
  finding.chi_square = current.chi_square - score.z * score.z;
  finding.share = calcShare(current.chi_square, finding.chi_square, current.degrees);
  finding.shifts = score.shifts.head(p).cwiseQuotient(scored.stddevs.head(p));
  return finding;
}

}  // namespace

double calcShare(double before, double after, double degrees) {
  return before > degrees ? std::clamp((before - after) / (before - degrees), 0.0, 1.0) : 0.0;
}

double calcLogSignEvidence(const TermCandidate& candidate, double estimate) {
  constexpr double kDriving = 0.05;  // the prior's share of negative coefficients of what dissipates
  return candidate.dissipates ? std::log(2.0 * (estimate < 0.0 ? kDriving : 1.0 - kDriving)) : 0.0;
}

bool hasMoreEvidence(const RankedTerm& a, const RankedTerm& b) {
  return a.finding.log_evidence > b.finding.log_evidence;
}

std::vector<RankedTerm> rankTerms(const ScoredCandidates& scored, const CurrentFit& current, Index p) {
  std::map<std::string, std::vector<RankedTerm>> of_term;
  for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
    if (scored.scores[i].visible) {
      of_term[scored.candidates[i].term].push_back({makeFinding(scored, i, current, p), i});
    }
  }
  std::vector<RankedTerm> ranked;
  for (auto& [term, scales] : of_term) {
    std::stable_sort(scales.begin(), scales.end(), hasMoreEvidence);
    const double best = scales.front().finding.log_evidence;
    double sum = 0.0;
    for (const RankedTerm& one : scales) {
      sum += std::exp(one.finding.log_evidence - best);
    }
    scales.front().finding.log_evidence = best + std::log(sum / static_cast<double>(scales.size()));
    ranked.push_back(std::move(scales.front()));
  }
  std::stable_sort(ranked.begin(), ranked.end(), hasMoreEvidence);
  return ranked;
}

void fitRanked(const CurrentFit& current, const RecordedFeatures& recordings, const ScoredCandidates& scored,
               Index p, double level, RankedTerm& ranked) {
  TermFinding& finding = ranked.finding;
  ranked.fitted =
      fitTerm(current.experiment, recordings, finding.candidate, scored.scores[ranked.index], current.point);
  const FittedTerm& fitted = ranked.fitted;
  // a term of size 0 fits as well as none
  if (fitted.point.size() == 0 || !(fitted.chi_square <= (1.0 + kSameNumber) * current.chi_square)) {
    finding.log_evidence = -kInfinity;
    return;
  }
  finding.fitted = true;
  finding.chi_square = fitted.chi_square;
  finding.estimate = fitted.estimate;
  finding.stddev = fitted.stddev;
  finding.share = calcShare(current.chi_square, fitted.chi_square, current.degrees);
  finding.log_evidence = calcLogEvidence(std::max(0.0, current.chi_square - fitted.chi_square),
                                         {fitted.estimate, fitted.stddev, finding.candidate.size}) +
                         fitted.log_evidence_of_scales +
                         calcLogSignEvidence(finding.candidate, fitted.estimate);
  finding.shifts = (fitted.point.head(p) - current.point.head(p)).cwiseQuotient(scored.stddevs.head(p));
  const double deviations = finding.candidate.is_share
                                ? std::sqrt(std::max(0.0, current.chi_square - fitted.chi_square))
                                : fitted.estimate / fitted.stddev;
  finding.holds_cautiously =
      calcPValue(deviations * fitted.stddev / fitted.cautious_stddev, scored.tested) < level;
  auto at = static_cast<Index>(current.experiment.model.parameters.size());
  for (OwnScale& scale : finding.candidate.own_scales) {
    scale.value = fitted.point[++at];
  }
}

CurrentFit addFitted(const CurrentFit& current, const RankedTerm& ranked) {
  const FittedTerm& best = ranked.fitted;
  CurrentFit next{best.augmented.experiment, best.point, best.chi_square,
                  std::max(1.0, current.degrees - static_cast<double>(best.augmented.added)), current.terms};
  next.terms.push_back(
      {ranked.finding.candidate, static_cast<Index>(current.experiment.model.parameters.size())});
  return next;
}

}  // namespace twinmap
