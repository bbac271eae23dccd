#include "framework/diagnosis/term_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/diagnosis/term_sets.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

/// So many of the best by their scores are fitted in the place of a term, and that term itself.
constexpr std::size_t kExchangeFits = 3;

/// Candidates in the place of a term, fitted beside the others; the largest evidence first.
struct Rivals {
  CurrentFit without;
  std::vector<RankedTerm> ranked;
  std::size_t present = 0;  ///< the term itself
};

std::optional<Rivals> findRivals(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                                 Index p, double level, const CurrentFit& fit, std::size_t out) {
  const auto isPresent = [&](const RankedTerm& one) {
    return one.finding.candidate.term == fit.terms[out].candidate.term;
  };
  Rivals rivals{fitWithout(without_terms, recordings, fit, out), {}};
  if (rivals.without.point.size() == 0) {
    return {};
  }
  const ScoredCandidates scored =
      scoreCandidates(rivals.without.experiment, recordings, rivals.without.point);
  std::vector<RankedTerm>& ranked = rivals.ranked;
  ranked = rankTerms(scored, rivals.without, p);
  const auto present = std::find_if(ranked.begin(), ranked.end(), isPresent);
  if (present == ranked.end()) {
    return {};
  }
  std::rotate(ranked.begin(), present, present + 1);
  ranked.resize(std::min(ranked.size(), kExchangeFits + 1));
  for (RankedTerm& one : ranked) {
    fitRanked(rivals.without, recordings, scored, p, level, one);
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
         best.chi_square < fit.chi_square + kNoticedChiSquare;
}

/// Those that cannot be told from `chosen`.
std::vector<std::string> listTied(const Rivals& rivals, std::size_t chosen) {
  std::vector<std::string> tied;
  for (std::size_t i = 0; i < rivals.ranked.size(); ++i) {
    const TermFinding& one = rivals.ranked[i].finding;
    if (i != chosen && one.fitted &&
        std::abs(rivals.ranked[chosen].finding.log_evidence - one.log_evidence) < kTiedEvidence) {
      tied.push_back(one.candidate.term);
    }
  }
  return tied;
}

}  // namespace

std::vector<TermRival> exchangeTerms(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                                     Index p, double level, CurrentFit& fit) {
  std::vector<TermRival> found;
  const std::size_t earlier = fit.terms.size() - 1;
  for (std::size_t tried = 0, at = 0; tried < earlier; ++tried) {
    const std::optional<Rivals> rivals = findRivals(without_terms, recordings, p, level, fit, at);
    if (!rivals) {
      ++at;
      continue;
    }
    std::string term = fit.terms[at].candidate.term;
    std::size_t chosen = rivals->present;
    if (takesOver(*rivals, fit)) {
      chosen = 0;
      found.push_back({term, rivals->ranked.front().finding.candidate.term, true});
      term = found.back().rival;
      fit = addFitted(rivals->without, rivals->ranked.front());  // at the end: the next has this number
    } else {
      ++at;
    }
    for (const std::string& tied : listTied(*rivals, chosen)) {
      found.push_back({term, tied, false});
    }
  }
  return found;
}

}  // namespace twinmap
