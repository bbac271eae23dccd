#include "framework/diagnosis/term_search.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/log/search_stage.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/diagnosis/second_test.hpp"
#include "framework/diagnosis/term_exchange.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// So many of the best by their scores are fitted: the linear model ranks them wrongly where the misfit is
/// large.
constexpr std::size_t kFittedTerms = 6;

/// Of the level, for pairs of terms: singles have the rest.
constexpr double kPairShare = 0.1;

/// Whether chi-square is no more than three standard deviations above its mean with a term.
bool isExplainedBy(const CurrentFit& current, const RankedTerm& single) {
  return single.finding.chi_square < current.degrees + 3.0 * std::sqrt(2.0 * current.degrees);
}

/// Whether a fit ended elsewhere than the linear model said, by more than is noticed.
bool isBent(const CurrentFit& current, const RankedTerm& one) {
  const double linear = current.chi_square - one.finding.z * one.finding.z;
  return one.finding.fitted && std::abs(one.finding.chi_square - linear) > kBasinReach * kBasinReach;
}

/// Of those that evidence does not tell apart, one that stands out of what remains comes first: the freedom
/// of another's scales may hide that it is needed.
void putSteadyFirst(std::vector<RankedTerm>& ranked) {
  const double best = ranked.front().finding.log_evidence;
  const auto steady = std::find_if(ranked.begin(), ranked.end(), [best](const RankedTerm& one) {
    return one.finding.fitted && one.finding.holds_cautiously &&
           best - one.finding.log_evidence < kTiedEvidence;
  });
  if (steady != ranked.end()) {
    std::rotate(ranked.begin(), steady, steady + 1);
  }
}

/// Puts a term first.
std::size_t takeAccepted(const std::string& term, std::vector<RankedTerm>& ranked) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    names.push_back(ranked[i].finding.candidate.term);
    if (names.back() == term) {
      std::rotate(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(i),
                  ranked.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return 1;
    }
  }
  throw ExperimentError(
      "'" + term +
      "' is not a term that these recordings can tell from the parameters; leave --accept out "
      "for a list of those that they can" +
      suggestName(term, names));
}

}  // namespace

TermSearch::TermSearch(const RecordedFeatures& recordings, const DiagnosisOptions& options, CurrentFit first,
                       bool is_explained, Index shared)
    : recordings_(recordings),
      options_(options),
      fits_{std::move(first)},
      is_explained_(is_explained),
      shared_(shared) {}

DiagnosisStep TermSearch::takeStep(std::size_t number) {
  const CurrentFit current = fits_.back();
  const ScoredCandidates scored =
      scoreCandidates(current.experiment, recordings_, current.point, options_.candidates);
  std::vector<RankedTerm> ranked = rankTerms(scored, current, shared_);
  DiagnosisStep step{current.chi_square, current.degrees, scored.tested, {}};
  const bool is_given = !options_.accepted.empty();
  const std::size_t fitted =
      is_given ? takeAccepted(options_.accepted[number], ranked) : countSignificant(ranked);
  rankByFits(current, scored, fitted, ranked);
  step.found =
      fitted > 0 && ranked.front().finding.fitted && (is_given || ranked.front().finding.log_evidence > 0.0);
  if (is_given && !step.found) {
    throw std::runtime_error(options_.accepted[number] + ": no fit with this term succeeded");
  }
  for (const RankedTerm& one : ranked) {
    step.ranked.push_back(one.finding);
  }
  const std::optional<FittedPair> pair =
      is_given ? std::nullopt : findBetterPair(current, scored, step.found ? &ranked.front() : nullptr);
  if (pair) {
    takePair(*pair, step);
  } else if (step.found) {
    takeFirst(current, ranked, step);
  }
  return step;
}

void TermSearch::rankByFits(const CurrentFit& current, const ScoredCandidates& scored, std::size_t count,
                            std::vector<RankedTerm>& ranked) const {
  SearchStage stage("fit the best candidates", static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    fitRanked(current, recordings_, scored, shared_, options_.level, ranked[i]);
    stage.advance();
  }
  if (count == 0 || !options_.accepted.empty()) {
    return;
  }
  std::stable_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), hasMoreEvidence);
  if (isBent(current, ranked.front())) {
    fitAgain(current, scored, ranked);
  }
  putSteadyFirst(ranked);
}

void TermSearch::fitAgain(const CurrentFit& current, const ScoredCandidates& scored,
                          std::vector<RankedTerm>& ranked) const {
  CurrentFit near = current;  // its chi-square is what the terms are held to
  const VectorXd& best = ranked.front().fitted.point;
  const auto all = static_cast<Index>(current.experiment.model.parameters.size());
  near.point.head(all) = best.head(all);
  near.point.tail(current.point.size() - all) = best.tail(current.point.size() - all);
  std::optional<ScoredCandidates> scored_again;
  try {
    scored_again = scoreCandidates(current.experiment, recordings_, near.point, options_.candidates);
  } catch (const std::runtime_error&) {
    return;  // without the term, the model may not be simulated there
  }
  const ScoredCandidates& again = *scored_again;
  std::vector<RankedTerm> there = rankTerms(again, near, shared_);
  there.resize(std::min(there.size(), kFittedTerms), RankedTerm{{}});
  for (RankedTerm& one : there) {
    const auto known = std::find_if(ranked.begin(), ranked.end(), [&](const RankedTerm& other) {
      return other.finding.candidate.term == one.finding.candidate.term;
    });
    if (known == ranked.end() || !(known->finding.p_value < (1.0 - kPairShare) * options_.level)) {
      continue;
    }
    one.finding.z = known->finding.z;
    one.finding.p_value = known->finding.p_value;
    fitRanked(near, recordings_, again, shared_, options_.level, one);
    if (one.finding.fitted && (!known->finding.fitted || hasMoreEvidence(one, *known))) {
      one.finding.shifts = (one.fitted.point.head(shared_) - current.point.head(shared_))
                               .cwiseQuotient(scored.stddevs.head(shared_));
      *known = std::move(one);
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedTerm& a, const RankedTerm& b) {
    return a.finding.fitted != b.finding.fitted ? a.finding.fitted : hasMoreEvidence(a, b);
  });
}

void TermSearch::takeFirst(const CurrentFit& current, const std::vector<RankedTerm>& ranked,
                           DiagnosisStep& step) {
  const bool is_given = !options_.accepted.empty();
  if (!is_given) {
    setTied(current, ranked, step);
  }
  step.log_evidence = ranked.front().finding.log_evidence;
  CurrentFit next = addFitted(current, ranked.front());
  Exchange exchange;
  if (!is_given) {
    step.dropped = dropSuperfluous(fits_.front().experiment, recordings_, next);
    exchange =
        exchangeTerms(fits_.front().experiment, recordings_, shared_, options_, next.terms.size() - 1, next);
    step.rivals = exchange.rivals;
  }
  fits_.push_back(std::move(next));
  alternatives_.push_back(std::move(exchange.alternatives));
  if (exchange.took_over || !step.dropped.empty()) {
    return;  // what is tied was fitted beside terms that are there no more
  }
  for (std::size_t i = 1; i < step.tied; ++i) {
    const FittedTerm& tied = ranked[i].fitted;
    alternatives_.back().push_back({tied.augmented.experiment, tied.point,
                                    ranked[i].finding.log_evidence - ranked.front().finding.log_evidence});
  }
}

void TermSearch::takePair(const FittedPair& pair, DiagnosisStep& step) {
  step.found = true;
  const auto same = std::find_if(step.ranked.begin(), step.ranked.end(), [&](const TermFinding& one) {
    return one.candidate.term == pair.first.candidate.term;
  });
  TermFinding first = pair.first;
  if (same != step.ranked.end()) {
    first.z = same->z;
    first.p_value = same->p_value;
    step.ranked.erase(same);
  }
  step.ranked.insert(step.ranked.begin(), first);
  step.partner = pair.second;
  step.log_evidence = pair.log_evidence;
  CurrentFit next = pair.fit;
  Exchange exchange =
      exchangeTerms(fits_.front().experiment, recordings_, shared_, options_, next.terms.size(), next);
  step.rivals = exchange.rivals;
  fits_.push_back(std::move(next));
  alternatives_.push_back(std::move(exchange.alternatives));
}

/// Two terms that are missing together, where the best single one, if there is one, leaves something
/// unexplained and is none of them. They must explain more than it does with any other.
std::optional<FittedPair> TermSearch::findBetterPair(const CurrentFit& current,
                                                     const ScoredCandidates& scored,
                                                     const RankedTerm* single) const {
  const bool has_room = current.terms.size() + 2 <= static_cast<std::size_t>(options_.max_terms);
  const bool is_explained =
      single != nullptr ? isExplainedBy(current, *single) : current.terms.empty() && is_explained_;
  const std::optional<TermPair> best =
      has_room && !is_explained ? findPair(scored) : std::optional<TermPair>();
  if (!best || best->p_value > kPairShare * options_.level) {
    return {};
  }
  std::optional<FittedPair> with_single;
  if (single != nullptr) {
    const std::string& term = single->finding.candidate.term;
    if (scored.candidates[best->first].term == term || scored.candidates[best->second].term == term) {
      return {};
    }
    const std::optional<TermPair> rival = findPair(scored, term);
    if (rival && best->log_evidence - rival->log_evidence < kTiedEvidence) {
      return {};
    }
    with_single =
        rival ? fitPair(current, recordings_, scored, *rival, shared_, options_.level) : with_single;
  }
  std::optional<FittedPair> fitted = fitPair(current, recordings_, scored, *best, shared_, options_.level);
  const double least = std::max(with_single ? with_single->log_evidence : 0.0,
                                single != nullptr ? single->finding.log_evidence : 0.0);
  return fitted && fitted->log_evidence > least + kTiedEvidence ? fitted : std::nullopt;
}

std::size_t TermSearch::countSignificant(const std::vector<RankedTerm>& ranked) const {
  const auto isFitted = [&](std::size_t i) {
    const TermFinding &one = ranked[i].finding, &best = ranked.front().finding;
    return one.p_value < (1.0 - kPairShare) * options_.level &&
           (i < kFittedTerms || best.log_evidence - one.log_evidence < kTiedEvidence);
  };
  std::size_t count = 0;
  while (count < std::min(ranked.size(), kFittedAlike) && isFitted(count)) {
    ++count;
  }
  return count;
}

/// Those whose evidence is hardly less than that of the first, and the test that would tell.
void TermSearch::setTied(const CurrentFit& current, const std::vector<RankedTerm>& ranked,
                         DiagnosisStep& step) const {
  std::vector<const FittedTerm*> tied;
  for (const RankedTerm& one : ranked) {
    if (!one.finding.fitted ||
        !(ranked.front().finding.log_evidence - one.finding.log_evidence < kTiedEvidence)) {
      break;
    }
    tied.push_back(&one.fitted);
  }
  step.tied = tied.size();
  if (step.tied > 1) {
    step.advice = adviseSecondTest(current.experiment, recordings_, tied);
  }
}

}  // namespace twinmap
