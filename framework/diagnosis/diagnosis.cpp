#include "framework/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/diagnosis/second_test.hpp"
#include "framework/diagnosis/term_exchange.hpp"
#include "framework/diagnosis/term_sets.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// So many of the best by their scores are fitted: the linear model ranks them wrongly where the misfit is
/// large.
constexpr std::size_t kFittedTerms = 6;

/// Of the level, for pairs of terms: singles have the rest.
constexpr double kPairShare = 0.1;

/// Without the searches and draws that only a posterior to be believed is worth.
ExplainedFit explain(const RecordingsProblem& problem, const MatrixXd& given,
                     SimulatorPosteriorOptions options) {
  options.search.settles = true;
  options.spares_misfit = true;
  ExplainedFit fit{samplePosterior(problem.get(), given, options), {}};
  if (!(fit.posterior.degrees > 0.0)) {
    throw std::runtime_error(fit.posterior.message);
  }
  fit.test = testResidual(fit.posterior.residual, fit.posterior.degrees, problem.listInfos());
  return fit;
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
    is_explained_ = diagnosis.before.isExplained();
    shared_ = static_cast<Index>(experiment.model.parameters.size());
    const std::size_t most =
        options_.accepted.empty() ? static_cast<std::size_t>(options_.max_terms) : options_.accepted.size();
    // each step adds a term or two, some drop one: twice as many end a search that would go round
    while (fits_.back().terms.size() < most && diagnosis.found < 2 * most) {
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
      fitRanked(current, recordings_, scored, shared_, options_.level, ranked[i]);
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
    const std::optional<FittedPair> pair =
        is_given ? std::nullopt : findBetterPair(current, scored, step.found ? &ranked.front() : nullptr);
    if (pair) {
      takePair(*pair, step);
    } else if (step.found) {
      takeFirst(current, ranked, step);
    }
    return step;
  }

  void takeFirst(const CurrentFit& current, const std::vector<RankedTerm>& ranked, DiagnosisStep& step) {
    const bool is_given = !options_.accepted.empty();
    if (!is_given) {
      setTied(current, step);
    }
    step.log_evidence = ranked.front().finding.log_evidence;
    CurrentFit next = addFitted(current, ranked.front());
    if (!is_given) {
      step.dropped = dropSuperfluous(fits_.front().experiment, recordings_, next);
      step.rivals = exchangeTerms(fits_.front().experiment, recordings_, shared_, options_.level, next);
    }
    fits_.push_back(std::move(next));
    const bool is_same = std::none_of(step.rivals.begin(), step.rivals.end(),
                                      [](const TermRival& rival) { return rival.took_over; });
    const std::size_t averaged = is_same ? step.tied : 0;  // fitted beside terms that are there still
    tied_.emplace_back(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(averaged));
  }

  void takePair(const FittedPair& pair, DiagnosisStep& step) {
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
    fits_.push_back(pair.fit);
    tied_.emplace_back();
  }

  /// Two terms that are missing together, where the best single one, if there is one, leaves something
  /// unexplained and is none of them. They must explain more than it does with any other.
  std::optional<FittedPair> findBetterPair(const CurrentFit& current, const ScoredCandidates& scored,
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
      if (rival && best->score.log_evidence - rival->score.log_evidence < kTiedEvidence) {
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

  /// Whether chi-square is no more than three standard deviations above its mean with a term.
  static bool isExplainedBy(const CurrentFit& current, const RankedTerm& single) {
    return single.finding.chi_square < current.degrees + 3.0 * std::sqrt(2.0 * current.degrees);
  }

  std::size_t countSignificant(const std::vector<RankedTerm>& ranked) const {
    std::size_t count = 0;
    while (count < std::min(ranked.size(), kFittedTerms) &&
           ranked[count].finding.p_value < (1.0 - kPairShare) * options_.level) {
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

  /// Whether what was found stands out of what remains, both of a pair.
  static bool holdsCautiously(const DiagnosisStep& step) {
    return step.ranked.front().holds_cautiously && (!step.partner || step.partner->holds_cautiously);
  }

  /// Takes the last terms back that stand in for something else, then infers with those that are left.
  void finish(Diagnosis& diagnosis) {
    diagnosis.after = diagnosis.before;
    while (diagnosis.found > 0) {
      const CurrentFit& last = fits_[diagnosis.found];
      const RecordingsProblem problem(last.experiment, recordings_);
      diagnosis.after = explain(problem, last.point, makeFittedOptions());
      DiagnosisStep& step = diagnosis.steps[diagnosis.found - 1];
      if (!options_.accepted.empty() || diagnosis.after.isExplained() || holdsCautiously(step)) {
        break;
      }
      step.found = false;
      diagnosis.steps.resize(diagnosis.found--);
      diagnosis.after = diagnosis.before;
    }
    diagnosis.corrected = fits_[diagnosis.found].experiment;
    diagnosis.terms = fits_[diagnosis.found].terms;
    average(diagnosis);
    if (!diagnosis.after.isExplained()) {
      diagnosis.remainder =
          findRemainder(diagnosis.corrected, recordings_, diagnosis.after.posterior.best, shared_);
    }
    if (diagnosis.found > 0 && options_.accepted.empty()) {
      diagnosis.process = findBetterProcess(diagnosis);
    }
  }

  /// Instead of all terms.
  std::optional<Remainder> findBetterProcess(const Diagnosis& diagnosis) const {
    double of_terms = 0.0;
    for (std::size_t i = 0; i < diagnosis.found; ++i) {
      of_terms += diagnosis.steps[i].log_evidence;
    }
    std::optional<Remainder> process =
        findRemainder(fits_.front().experiment, recordings_, diagnosis.before.posterior.best, shared_);
    return process && process->log_evidence > of_terms + kTiedEvidence ? process : std::nullopt;
  }

  const RecordedFeatures& recordings_;
  const DiagnosisOptions& options_;
  std::vector<CurrentFit> fits_;               // without a term, then with one more each
  std::vector<std::vector<RankedTerm>> tied_;  // of each step that found one, that one first
  bool is_explained_ = false;                  // without any term
  Index shared_ = 0;                           // parameters of the machine, before any term
};

/// Gives `sized`, which was fitted, the unknown sizes of noise that the fit shows.
void sizeNoiseBy(const ExplainedFit& fit, const ExperimentSpec& stated, const RecordedFeatures& recordings,
                 ExperimentSpec& sized) {
  const std::vector<FeatureInfo> infos = RecordingsProblem(stated, recordings).listInfos();
  const std::vector<std::string> outputs = recordings.listOutputs(stated);
  const auto size = [&](const ExperimentSpec& from, const std::vector<std::string>& names,
                        ExperimentSpec& to) {
    to.noise = sizeNoise(from.noise, {to.noise, fit.posterior.residual, fit.posterior.degrees, infos}, names);
  };
  for (std::size_t t = 0; t < sized.trials.size(); ++t) {
    const std::string prefix = nameInTrial(sized.trials[t].name, "");
    std::vector<std::string> own;
    for (const std::string& output : outputs) {
      own.push_back(output.rfind(prefix, 0) == 0 ? output.substr(prefix.size()) : "");
    }
    size(stated.trials[t].experiment, own, sized.trials[t].experiment);
  }
  size(stated, outputs, sized);
}

/// With the noise that is left by what was found: as long as more is found.
void diagnoseAgain(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const DiagnosisOptions& options, ExperimentSpec& sized, Diagnosis& diagnosis) {
  constexpr int kRounds = 4;  // at most three terms are found, mostly at once
  for (int round = 0; round < kRounds && diagnosis.found > 0; ++round) {
    const std::vector<std::string> before = diagnosis.listTerms();
    sizeNoiseBy(diagnosis.after, experiment, recordings, sized);
    diagnosis = Diagnoser(recordings, options).run(sized);
    if (diagnosis.listTerms() == before) {
      return;
    }
  }
}

}  // namespace

MatrixXd AveragedEstimate::calcQuantiles(const VectorXd& probabilities) const {
  return importance::calcQuantiles({draws, weights}, probabilities);
}

std::vector<std::string> Diagnosis::listAtBounds() const {
  constexpr double kNear = 0.01;  // of the width
  std::vector<std::string> names;
  const VectorXd& best = before.posterior.best;
  for (std::size_t i = 0; i < shared && best.size() > 0 && !before.isExplained(); ++i) {
    const ParameterSpec& parameter = corrected.model.parameters[i];
    const double value = best[static_cast<Index>(i)];
    const double width = parameter.bounds.upper - parameter.bounds.lower;
    if (std::min(value - parameter.bounds.lower, parameter.bounds.upper - value) < kNear * width) {
      names.push_back(parameter.name.text);
    }
  }
  return names;
}

const char* Diagnosis::getStatus() const {
  if (isIncomplete()) {
    return getNotice(Notice::kModelIncomplete).name;
  }
  return getNotice(found > 0 && !after.posterior.isReliable() ? Notice::kUnreliable : Notice::kOk).name;
}

std::vector<std::string> Diagnosis::listTerms() const {
  std::vector<std::string> names;
  for (const FoundTerm& term : terms) {
    names.push_back(term.candidate.term);
  }
  return names;
}

Diagnosis diagnose(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                   const DiagnosisOptions& options) {
  requireSystem(experiment);
  ExperimentSpec sized = experiment;
  if (hasUnknownNoise(experiment.noise)) {
    const RecordingsProblem problem(experiment, recordings);
    const MatrixXd none(static_cast<Index>(problem.getUnknown().size()), 0);
    sizeNoiseBy(explain(problem, none, options.posterior), experiment, recordings, sized);
  }
  Diagnosis diagnosis = Diagnoser(recordings, options).run(sized);
  if (hasUnknownNoise(experiment.noise)) {
    diagnoseAgain(experiment, recordings, options, sized, diagnosis);
  }
  diagnosis.noise = sized.noise;
  copyNoise(experiment, diagnosis.corrected);
  return diagnosis;
}

}  // namespace twinmap
