#include "framework/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "framework/base/text/nearest_name.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/diagnosis/second_test.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// So many of the best by their scores are fitted: the linear model ranks them wrongly where the misfit is
/// large.
constexpr std::size_t kFittedTerms = 6;

/// An experiment and where it fits the recordings best.
struct CurrentFit {
  ExperimentSpec experiment;
  VectorXd point;
  double chi_square = 0.0, degrees = 0.0;
};

/// A finding with what fitted it.
struct RankedTerm {
  TermFinding finding;
  TermScore score;
  FittedTerm fitted;
};

ExplainedFit explain(const RecordingsProblem& problem, const MatrixXd& given,
                     const SimulatorPosteriorOptions& options) {
  ExplainedFit fit{samplePosterior(problem.get(), given, options), {}};
  if (!(fit.posterior.degrees > 0.0)) {
    throw std::runtime_error(fit.posterior.message);
  }
  fit.test = testResidual(fit.posterior.residual, fit.posterior.degrees, problem.listInfos());
  return fit;
}

double calcShare(double before, double after, double degrees) {
  return before > degrees ? std::clamp((before - after) / (before - degrees), 0.0, 1.0) : 0.0;
}

/// log of what the sign of a coefficient has for it: friction that drives is rare. With even odds for the
/// others, 0.
double calcLogSignEvidence(const TermCandidate& candidate, double estimate) {
  constexpr double kDriving = 0.05;  // the prior's share of negative coefficients of what dissipates
  return candidate.dissipates ? std::log(2.0 * (estimate < 0.0 ? kDriving : 1.0 - kDriving)) : 0.0;
}

TermFinding makeFinding(const ScoredCandidates& scored, std::size_t i, const CurrentFit& current, Index p) {
  TermFinding finding{scored.candidates[i]};
  const TermScore& score = scored.scores[i];
  finding.estimate = score.estimate;
  finding.stddev = score.stddev;
  finding.z = score.z;
  finding.p_value = calcPValue(score.z, scored.tested);
  finding.log_evidence = calcLogEvidence(score.z * score.z, score.stddev, finding.candidate.size) +
                         calcLogSignEvidence(finding.candidate, score.estimate);
  finding.chi_square = current.chi_square - score.z * score.z;
  finding.share = calcShare(current.chi_square, finding.chi_square, current.degrees);
  finding.shifts = score.shifts.head(p).cwiseQuotient(scored.stddevs.head(p));
  return finding;
}

bool hasMoreEvidence(const RankedTerm& a, const RankedTerm& b) {
  return a.finding.log_evidence > b.finding.log_evidence;
}

/// The terms, the best first, each at the best of its own scales. What a scan costs in evidence is that the
/// other scales are not so good: their mean counts.
std::vector<RankedTerm> rankTerms(const ScoredCandidates& scored, const CurrentFit& current, Index p) {
  std::map<std::string, std::vector<RankedTerm>> of_term;
  for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
    if (scored.scores[i].visible) {
      of_term[scored.candidates[i].term].push_back(
          {makeFinding(scored, i, current, p), scored.scores[i], {}});
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

/// The first p parameters of several posteriors with weights; nothing where one is not reliable.
AveragedEstimate mix(const std::vector<SimulatorPosterior>& posteriors, const std::vector<double>& weights,
                     Index p) {
  AveragedEstimate mixed;
  for (std::size_t i = 0; i < posteriors.size(); ++i) {
    if (!posteriors[i].isReliable()) {
      return {};
    }
    const Index before = mixed.weights.size(), count = posteriors[i].weights.size();
    mixed.draws.conservativeResize(p, before + count);
    mixed.draws.rightCols(count) = posteriors[i].draws.topRows(p);
    mixed.weights.conservativeResize(before + count);
    mixed.weights.tail(count) = weights[i] * posteriors[i].weights;
  }
  mixed.weights /= mixed.weights.sum();
  mixed.mean = importance::calcMean({mixed.draws, mixed.weights});
  mixed.stddev = importance::calcCovariance({mixed.draws, mixed.weights}).diagonal().cwiseSqrt();
  return mixed;
}

/// One diagnosis on its way.
class Diagnoser {
 public:
  Diagnoser(const RecordedFeatures& recordings, const DiagnosisOptions& options)
      : recordings_(recordings), options_(options) {}

  Diagnosis run(const ExperimentSpec& experiment) {
    const RecordingsProblem problem(experiment, recordings_);
    const auto u = static_cast<Index>(problem.getUnknown().size());
    Diagnosis diagnosis;
    diagnosis.level = options_.level;
    diagnosis.shared = experiment.model.parameters.size();
    diagnosis.before = explain(problem, MatrixXd(u, 0), options_.posterior);
    const SimulatorPosterior& before = diagnosis.before.posterior;
    fits_ = {{experiment, before.best, before.chi_square, before.degrees}};
    shared_ = static_cast<Index>(experiment.model.parameters.size());
    const std::size_t most =
        options_.accepted.empty() ? static_cast<std::size_t>(options_.max_terms) : options_.accepted.size();
    while (diagnosis.found < most) {
      diagnosis.steps.push_back(takeStep(diagnosis.found));
      if (!diagnosis.steps.back().found) {
        break;
      }
      ++diagnosis.found;
    }
    finish(diagnosis);
    return diagnosis;
  }

 private:
  DiagnosisStep takeStep(std::size_t number) {
    const CurrentFit current = fits_.back();
    const ScoredCandidates scored = scoreCandidates(current.experiment, recordings_, current.point);
    std::vector<RankedTerm> ranked = rankTerms(scored, current, shared_);
    DiagnosisStep step{current.chi_square, current.degrees, scored.tested, {}};
    const bool is_given = !options_.accepted.empty();
    const std::size_t fitted =
        is_given ? takeAccepted(options_.accepted[number], ranked) : countSignificant(ranked);
    for (std::size_t i = 0; i < fitted; ++i) {
      fitRanked(current, scored, ranked[i]);
    }
    std::stable_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(fitted), hasMoreEvidence);
    step.found = fitted > 0 && ranked.front().finding.fitted &&
                 (is_given || ranked.front().finding.log_evidence > 0.0);
    if (is_given && !step.found) {
      throw std::runtime_error(options_.accepted[number] + ": no fit with this term succeeded");
    }
    for (const RankedTerm& one : ranked) {
      step.ranked.push_back(one.finding);
    }
    if (step.found) {
      if (!is_given) {
        setTied(current, step);
      }
      const FittedTerm& best = ranked.front().fitted;
      fits_.push_back({best.augmented.experiment, best.point, best.chi_square,
                       std::max(1.0, current.degrees - static_cast<double>(best.augmented.added))});
      tied_.emplace_back(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(step.tied));
    }
    return step;
  }

  std::size_t countSignificant(const std::vector<RankedTerm>& ranked) const {
    std::size_t count = 0;
    while (count < std::min(ranked.size(), kFittedTerms) && ranked[count].finding.p_value < options_.level) {
      ++count;
    }
    return count;
  }

  /// Puts a term first.
  static std::size_t takeAccepted(const std::string& term, std::vector<RankedTerm>& ranked) {
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

  void fitRanked(const CurrentFit& current, const ScoredCandidates& scored, RankedTerm& ranked) const {
    const VectorXd stddevs = scored.stddevs.head(shared_);
    ranked.fitted =
        fitTerm(current.experiment, recordings_, ranked.finding.candidate, ranked.score, current.point);
    const FittedTerm& fitted = ranked.fitted;
    TermFinding& finding = ranked.finding;
    constexpr double kWorse = 1e-6;  // of chi-square: a term of size 0 fits as well as none, up to rounding
    if (fitted.point.size() == 0 || !(fitted.chi_square <= (1.0 + kWorse) * current.chi_square)) {
      finding.log_evidence = -kInfinity;
      return;
    }
    finding.fitted = true;
    finding.chi_square = fitted.chi_square;
    finding.estimate = fitted.estimate;
    finding.stddev = fitted.stddev;
    finding.share = calcShare(current.chi_square, fitted.chi_square, current.degrees);
    finding.log_evidence =
        calcLogEvidence(std::max(0.0, current.chi_square - fitted.chi_square), fitted.stddev,
                        std::max(finding.candidate.size, std::abs(fitted.estimate))) +
        fitted.log_evidence_of_scale + calcLogSignEvidence(finding.candidate, fitted.estimate);
    finding.shifts = (fitted.point.head(shared_) - current.point.head(shared_)).cwiseQuotient(stddevs);
    finding.holds_cautiously =
        calcPValue(fitted.estimate / fitted.cautious_stddev, scored.tested) < options_.level;
    if (finding.candidate.own_scale) {
      const auto at = static_cast<Index>(current.experiment.model.parameters.size()) + 1;
      finding.candidate.own_scale->value = fitted.point[at];
    }
  }

  /// Those whose evidence is hardly less than that of the first, and the test that would tell.
  void setTied(const CurrentFit& current, DiagnosisStep& step) const {
    while (step.tied < step.ranked.size() && step.ranked[step.tied].fitted &&
           step.ranked.front().log_evidence - step.ranked[step.tied].log_evidence < kTiedEvidence) {
      ++step.tied;
    }
    if (step.tied > 1) {
      const std::vector<TermFinding> tied(step.ranked.begin(),
                                          step.ranked.begin() + static_cast<std::ptrdiff_t>(step.tied));
      step.advice = adviseSecondTest(current.experiment, recordings_, current.point, tied);
    }
  }

  /// Of a posterior whose search begins where a term was fitted.
  SimulatorPosteriorOptions makeFittedOptions() const {
    constexpr int kOwnStarts = 8;
    SimulatorPosteriorOptions options = options_.posterior;
    options.search.scouts = kOwnStarts;
    options.search.starts = 2 * kOwnStarts;
    options.search.max_batches = 1;
    return options;
  }

  /// The shared parameters over all terms tied with the last one found.
  void average(Diagnosis& diagnosis) const {
    std::vector<SimulatorPosterior> posteriors{diagnosis.after.posterior};
    std::vector<double> evidence{1.0};
    for (std::size_t i = 1; diagnosis.found > 0 && i < tied_[diagnosis.found - 1].size(); ++i) {
      const std::vector<RankedTerm>& tied = tied_[diagnosis.found - 1];
      const RecordingsProblem problem(tied[i].fitted.augmented.experiment, recordings_);
      posteriors.push_back(samplePosterior(problem.get(), tied[i].fitted.point, makeFittedOptions()));
      evidence.push_back(std::exp(tied[i].finding.log_evidence - tied.front().finding.log_evidence));
    }
    diagnosis.averaged = mix(posteriors, evidence, shared_);
  }

  /// Takes the last terms back that stand in for something else, then infers with those that are left.
  void finish(Diagnosis& diagnosis) {
    diagnosis.after = diagnosis.before;
    while (diagnosis.found > 0) {
      const CurrentFit& last = fits_[diagnosis.found];
      const RecordingsProblem problem(last.experiment, recordings_);
      diagnosis.after = explain(problem, last.point, makeFittedOptions());
      DiagnosisStep& step = diagnosis.steps[diagnosis.found - 1];
      if (!options_.accepted.empty() || diagnosis.after.isExplained() ||
          step.ranked.front().holds_cautiously) {
        break;
      }
      step.found = false;
      diagnosis.steps.resize(diagnosis.found--);
      diagnosis.after = diagnosis.before;
    }
    diagnosis.corrected = fits_[diagnosis.found].experiment;
    average(diagnosis);
  }

  const RecordedFeatures& recordings_;
  const DiagnosisOptions& options_;
  std::vector<CurrentFit> fits_;               // without a term, then with one more each
  std::vector<std::vector<RankedTerm>> tied_;  // of each step that found one, that one first
  Index shared_ = 0;                           // parameters of the machine, before any term
};

}  // namespace

MatrixXd AveragedEstimate::calcQuantiles(const VectorXd& probabilities) const {
  return importance::calcQuantiles({draws, weights}, probabilities);
}

Diagnosis diagnose(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const DiagnosisOptions& options) {
  requireSystem(experiment);
  return Diagnoser(recordings, options).run(experiment);
}

}  // namespace twinmap
