#include "framework/diagnosis/term_exchange.hpp"

#include <algorithm>
#include <optional>

#include "framework/diagnosis/term_sets.hpp"

namespace twinmap {
namespace {

/// So many of the best by their scores are fitted in the place of a term, and that term itself.
constexpr std::size_t kExchangeFits = 3;

/// What is best in the place of a term, and that term again, both fitted beside the others.
struct Rivals {
  CurrentFit without;
  RankedTerm best, present;
};

std::optional<Rivals> findRivals(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                                 Eigen::Index p, double level, const CurrentFit& fit, std::size_t out) {
  const std::string& name = fit.terms[out].candidate.term;
  Rivals rivals{fitWithout(without_terms, recordings, fit, out), {}, {}};
  if (rivals.without.point.size() == 0) {
    return {};
  }
  const ScoredCandidates scored =
      scoreCandidates(rivals.without.experiment, recordings, rivals.without.point);
  std::vector<RankedTerm> ranked = rankTerms(scored, rivals.without, p);
  const auto present = std::find_if(ranked.begin(), ranked.end(), [&](const RankedTerm& one) {
    return one.finding.candidate.term == name;
  });
  if (present == ranked.end()) {
    return {};
  }
  std::rotate(ranked.begin(), present, present + 1);
  ranked.resize(std::min(ranked.size(), kExchangeFits + 1));
  for (RankedTerm& one : ranked) {
    fitRanked(rivals.without, recordings, scored, p, level, one);
  }
  rivals.present = ranked.front();
  rivals.best = *std::max_element(ranked.begin(), ranked.end(), [](const RankedTerm& a, const RankedTerm& b) {
    return hasMoreEvidence(b, a);
  });
  return rivals;
}

}  // namespace

std::vector<TermExchange> exchangeTerms(const ExperimentSpec& without_terms,
                                        const RecordedFeatures& recordings, Eigen::Index p, double level,
                                        CurrentFit& fit) {
  std::vector<TermExchange> exchanged;
  const std::size_t earlier = fit.terms.size() - 1;
  for (std::size_t tried = 0, at = 0; tried < earlier; ++tried) {
    const std::optional<Rivals> rivals = findRivals(without_terms, recordings, p, level, fit, at);
    if (!rivals || !rivals->best.finding.fitted) {
      ++at;
      continue;
    }
    const TermFinding &best = rivals->best.finding, &present = rivals->present.finding;
    constexpr double kNoticed = 9.0;  // of chi-square: three standard deviations, where the fit is not linear
    if (best.candidate.term != present.candidate.term &&
        best.log_evidence > present.log_evidence + kTiedEvidence &&
        best.chi_square < fit.chi_square + kNoticed) {
      exchanged.push_back({present.candidate.term, best.candidate.term});
      fit = addFitted(rivals->without, rivals->best);  // at the end: the next one has the same number
    } else {
      ++at;
    }
  }
  return exchanged;
}

}  // namespace twinmap
