#include "framework/diagnosis/term_sets.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Pairs by what they take from chi-square, the most first; both visible, of different terms.
std::vector<TermPair> listPairs(const ScoredCandidates& scored, const std::string& with) {
  const MatrixXd gains = scored.test->calcPairGains();
  std::vector<TermPair> pairs;
  const auto is_with = [&](std::size_t i) { return with.empty() || scored.candidates[i].term == with; };
  for (std::size_t j = 0; j < scored.candidates.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const double gain = gains(static_cast<Index>(i), static_cast<Index>(j));
      if (gain > 0.0 && scored.scores[i].visible && scored.scores[j].visible && (is_with(i) || is_with(j)) &&
          scored.candidates[i].term != scored.candidates[j].term) {
        pairs.push_back({i, j, {}});
        pairs.back().score.gain = gain;
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const TermPair& a, const TermPair& b) { return a.score.gain > b.score.gain; });
  return pairs;
}

/// The evidence of a coefficient that a model has, against the model without it and its own scales.
double calcTermEvidence(const LinearizedRecordings& linear, const CurrentFit& fit, const FoundTerm& term) {
  const std::vector<Index> others =
      listOthers(linear.jacobian.cols(), term.first, term.candidate.countCoefficients());
  const ScoreTest test(linear.residual, linear.jacobian(Eigen::all, others), linear.jacobian.col(term.first));
  const TermScore score = test.calcScore(0, kInfinity);
  const double estimate = fit.point[term.first];
  if (!score.visible) {
    return -kInfinity;
  }
  const double z = estimate / score.stddev;
  return calcLogEvidence(z * z, {estimate, score.stddev, term.candidate.size}) +
         calcLogSignEvidence(term.candidate, estimate);
}

/// What the freedom of a coefficient costs in evidence.
double calcLogPrior(const TermCandidate& candidate, double estimate, double stddev) {
  return calcLogEvidence(0.0, {estimate, stddev, candidate.size}) + calcLogSignEvidence(candidate, estimate);
}

/// Standard deviations of a coefficient: by the stated noise, and by what remains (calcCautiousStddev).
struct CoefficientStddev {
  double stated = kInfinity, cautious = kInfinity;
};

/// Of column `first`; where the coefficient `other` is 0, if that is one.
CoefficientStddev calcStddev(const LinearizedRecordings& linear, Index first, Index other) {
  std::vector<Index> others = listOthers(linear.jacobian.cols(), first, 1);
  others.erase(std::remove(others.begin(), others.end(), other), others.end());
  const ScoreTest test(linear.residual, linear.jacobian(Eigen::all, others), linear.jacobian.col(first));
  const TermScore score = test.calcScore(0, kInfinity);
  return score.visible ? CoefficientStddev{score.stddev, test.calcCautiousStddev(0, linear.starts)}
                       : CoefficientStddev{};
}

void describeOfPair(const CurrentFit& current, const ScoredCandidates& scored, Index p,
                    const FittedPair& pair, const FoundTerm& term, const CoefficientStddev& stddev,
                    double level, TermFinding& finding) {
  finding.estimate = pair.fit.point[term.first];
  finding.stddev = stddev.stated;
  finding.holds_cautiously = calcPValue(finding.estimate / stddev.cautious, scored.tested) < level;
  finding.chi_square = pair.fit.chi_square;
  finding.share = calcShare(current.chi_square, pair.fit.chi_square, current.degrees);
  finding.fitted = true;
  finding.log_evidence = pair.log_evidence;
  finding.shifts = (pair.fit.point.head(p) - current.point.head(p)).cwiseQuotient(scored.stddevs.head(p));
  for (std::size_t i = 0; i < finding.candidate.own_scales.size(); ++i) {
    finding.candidate.own_scales[i].value = pair.fit.point[term.first + 1 + static_cast<Index>(i)];
  }
}

/// Estimates, standard deviations and the evidence of both: Laplace's approximation, one after the other.
void describePair(const CurrentFit& current, const RecordedFeatures& recordings,
                  const ScoredCandidates& scored, Index p, double level, FittedPair& pair) {
  const std::size_t last = pair.fit.terms.size() - 1;
  const FoundTerm &first = pair.fit.terms[last - 1], &second = pair.fit.terms[last];
  LinearizedRecordings linear = RecordingsProblem(pair.fit.experiment, recordings).linearize(pair.fit.point);
  for (const FoundTerm* term : {&first, &second}) {
    linear = addScalePriors(linear, term->first, term->candidate, pair.fit.point);
    pair.log_evidence += calcScalesEvidence(linear, term->first, term->candidate, pair.fit.point);
  }
  const CoefficientStddev alone = calcStddev(linear, first.first, second.first);
  const CoefficientStddev of_first = calcStddev(linear, first.first, -1),
                          of_second = calcStddev(linear, second.first, -1);
  pair.log_evidence += 0.5 * (current.chi_square - pair.fit.chi_square) +
                       calcLogPrior(first.candidate, pair.fit.point[first.first], alone.stated) +
                       calcLogPrior(second.candidate, pair.fit.point[second.first], of_second.stated);
  describeOfPair(current, scored, p, pair, first, of_first, level, pair.first);
  describeOfPair(current, scored, p, pair, second, of_second, level, pair.second);
}

}  // namespace

std::optional<TermPair> findPair(const ScoredCandidates& scored, const std::string& with) {
  const double tests = 0.5 * scored.tested * (scored.tested - 1.0);
  std::optional<TermPair> best;
  for (TermPair& pair : listPairs(scored, with)) {
    const TermCandidate &first = scored.candidates[pair.first], &second = scored.candidates[pair.second];
    pair.score =
        scored.test->calcJointScore({static_cast<Index>(pair.first), static_cast<Index>(pair.second)});
    if (pair.score.estimates.size() == 0) {
      continue;
    }
    pair.log_evidence = 0.5 * pair.score.gain +
                        calcLogPrior(first, pair.score.estimates[0], pair.score.stddevs[0]) +
                        calcLogPrior(second, pair.score.estimates[1], pair.score.stddevs[1]);
    pair.p_value = calcPairPValue(pair.score.gain, tests);
    if (!best || pair.log_evidence > best->log_evidence) {
      best = pair;
    }
  }
  return best;
}

std::optional<FittedPair> fitPair(const CurrentFit& current, const RecordedFeatures& recordings,
                                  const ScoredCandidates& scored, const TermPair& pair, Index p,
                                  double level) {
  const auto all = static_cast<Index>(current.experiment.model.parameters.size());
  const bool swaps = std::abs(scored.scores[pair.second].z) > std::abs(scored.scores[pair.first].z);
  const TermCandidate& first = scored.candidates[swaps ? pair.second : pair.first];
  const std::size_t other = swaps ? pair.first : pair.second;
  const VectorXd estimates = swaps ? VectorXd(pair.score.estimates.reverse()) : pair.score.estimates;
  // the first one where the two together have it, not where it fits alone: there it may stand for both
  const AugmentedExperiment augmented =
      addTerm(current.experiment, first, std::max(first.size, kAboveScore * std::abs(estimates[0])));
  const VectorXd start = insertAdded(current.point + pair.score.shifts, all, first.listValues(estimates[0]));
  TermScore score = scored.scores[other];
  score.estimate = estimates[1];
  score.shifts = VectorXd::Zero(start.size());
  const FittedTerm fitted = fitTerm(augmented.experiment, recordings, scored.candidates[other], score, start);
  if (fitted.point.size() == 0 || !(fitted.chi_square < current.chi_square)) {
    return {};
  }
  FittedPair both{{first}, {scored.candidates[other]}, {}};
  const auto added = augmented.added + fitted.augmented.added;
  both.fit = {fitted.augmented.experiment, fitted.point, fitted.chi_square,
              std::max(1.0, current.degrees - static_cast<double>(added)), current.terms};
  both.fit.terms.push_back({first, all});
  both.fit.terms.push_back({scored.candidates[other], all + augmented.added});
  describePair(current, recordings, scored, p, level, both);
  const bool both_act = std::isfinite(both.first.stddev) && std::isfinite(both.second.stddev);
  return both_act ? std::optional<FittedPair>(both) : std::nullopt;
}

CurrentFit fitWithout(const ExperimentSpec& without_terms, const RecordedFeatures& recordings,
                      const CurrentFit& fit, std::size_t out) {
  CurrentFit next{without_terms, {}, 0.0, 0.0, {}};
  std::vector<double> values(fit.point.begin(),
                             fit.point.begin() + static_cast<Index>(without_terms.model.parameters.size()));
  double freed = 0.0;
  for (std::size_t i = 0; i < fit.terms.size(); ++i) {
    const FoundTerm& term = fit.terms[i];
    const Index count = term.candidate.countCoefficients();
    if (i == out) {
      freed = static_cast<double>(count);
      continue;
    }
    const Bounds& bounds = fit.experiment.model.parameters[static_cast<std::size_t>(term.first)].bounds;
    next.terms.push_back({term.candidate, static_cast<Index>(next.experiment.model.parameters.size())});
    next.experiment = addTerm(next.experiment, term.candidate, bounds.upper).experiment;
    values.insert(values.end(), fit.point.begin() + term.first, fit.point.begin() + term.first + count);
  }
  const auto all = static_cast<Index>(fit.experiment.model.parameters.size());
  values.insert(values.end(), fit.point.begin() + all, fit.point.end());
  const MatrixXd start = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  const RecordingFit found = RecordingsProblem(next.experiment, recordings).fit(start);
  next.point = found.point;
  next.chi_square = found.chi_square;
  next.degrees = fit.degrees + freed;
  return next;
}

std::vector<std::string> dropSuperfluous(const ExperimentSpec& without_terms,
                                         const RecordedFeatures& recordings, CurrentFit& fit) {
  std::vector<std::string> dropped;
  for (std::size_t i = 0; i + 1 < fit.terms.size();) {
    const LinearizedRecordings linear = RecordingsProblem(fit.experiment, recordings).linearize(fit.point);
    if (calcTermEvidence(linear, fit, fit.terms[i]) >= 0.0) {
      ++i;
      continue;
    }
    CurrentFit without = fitWithout(without_terms, recordings, fit, i);
    if (without.point.size() == 0 || without.chi_square > fit.chi_square + kBasinReach * kBasinReach) {
      ++i;
      continue;
    }
    dropped.push_back(fit.terms[i].candidate.term);
    fit = std::move(without);
  }
  return dropped;
}

}  // namespace twinmap
