#include "framework/diagnosis/term_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/diagnosis/term_sets.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

/// Candidates in the place of a term, fitted beside the others; the largest evidence first.
struct Rivals {
  CurrentFit without;
  std::vector<RankedTerm> ranked;
  std::size_t present = 0;  ///< the term itself
};

/// In the place of a term kFittedOfBest are fitted, and that term itself, and those that the scores hardly
/// tell from the best.
std::size_t countFitted(const std::vector<RankedTerm>& ranked) {
  std::size_t count = std::min(ranked.size(), kFittedOfBest);
  while (count < std::min(ranked.size(), kFittedAlike) &&
         ranked.front().finding.log_evidence - ranked[count].finding.log_evidence < kTiedEvidence) {
    ++count;
  }
  return count;
}

std::optional<Rivals> findRivals(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                                 Index p, const DiagnosisOptions& options, const CurrentFit& fit,
                                 std::size_t out) {
  const auto isPresent = [&](const RankedTerm& one) {
    return one.finding.candidate.term == fit.terms[out].candidate.term;
  };
  Rivals rivals{fitWithout(without_terms, recordings, fit, out), {}};
  if (rivals.without.point.size() == 0) {
    return {};
  }
  const ScoredCandidates scored =
      scoreCandidates(rivals.without.experiment, recordings, rivals.without.point, options.candidates);
  std::vector<RankedTerm>& ranked = rivals.ranked;
  ranked = rankTerms(scored, rivals.without, p);
  const auto present = std::find_if(ranked.begin(), ranked.end(), isPresent);
  if (present == ranked.end()) {
    return {};
  }
  const std::size_t fitted = countFitted(ranked);
  std::rotate(ranked.begin(), present, present + 1);
  ranked.resize(std::min(ranked.size(), fitted + 1));
  for (RankedTerm& one : ranked) {
    fitRanked(rivals.without, recordings, scored, p, options.level, one);
  }
  std::stable_sort(ranked.begin(), ranked.end(), hasMoreEvidence);
  rivals.present =
      static_cast<std::size_t>(std::find_if(ranked.begin(), ranked.end(), isPresent) - ranked.begin());
  return rivals;
}

/// Whether the first of the rivals is to take the term's place.
bool takesOver(const Rivals& rivals, const CurrentFit& fit) {
  const TermFinding &best = rivals.ranked.front().finding, &present = rivals.ranked[rivals.present].finding;
  return rivals.present != 0 && best.fitted && best.log_evidence > present.log_evidence + kTiedEvidence &&
         best.chi_square < fit.chi_square + kBasinReach * kBasinReach;
}

/// Adds those that cannot be told from `chosen`, which stands for `term`.
void addTied(const Rivals& rivals, std::size_t chosen, const std::string& term, Exchange& exchange) {
  for (std::size_t i = 0; i < rivals.ranked.size(); ++i) {
    const TermFinding& one = rivals.ranked[i].finding;
    const double against = one.log_evidence - rivals.ranked[chosen].finding.log_evidence;
    if (i != chosen && one.fitted && std::abs(against) < kTiedEvidence) {
      exchange.rivals.push_back({term, one.candidate.term, false});
      const FittedTerm& fitted = rivals.ranked[i].fitted;
      exchange.alternatives.push_back({fitted.augmented.experiment, fitted.point, against});
    }
  }
}

}  // namespace

Exchange exchangeTerms(const ExperimentSpec& without_terms, const RecordedFeatures& recordings, Index p,
                       const DiagnosisOptions& options, std::size_t count, CurrentFit& fit) {
  Exchange exchange;
  for (std::size_t tried = 0, at = 0; tried < count; ++tried) {
    const std::optional<Rivals> rivals = findRivals(without_terms, recordings, p, options, fit, at);
    if (!rivals) {
      ++at;
      continue;
    }
    std::string term = fit.terms[at].candidate.term;
    std::size_t chosen = rivals->present;
    if (takesOver(*rivals, fit)) {
      chosen = 0;
      exchange.took_over = true;
      exchange.alternatives.clear();  // those are beside a term that is there no more
      exchange.rivals.push_back({term, rivals->ranked.front().finding.candidate.term, true});
      term = exchange.rivals.back().rival;
      fit = addFitted(rivals->without, rivals->ranked.front());  // at the end: the next has this number
    } else {
      ++at;
    }
    addTied(*rivals, chosen, term, exchange);
  }
  return exchange;
}

}  // namespace twinmap
