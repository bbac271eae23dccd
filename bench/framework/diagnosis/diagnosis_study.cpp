// How often a diagnosis names the term that a model lacks:
//   diagnosis_study FILE.yaml [tests] [seed] [TERM ...]
// simulates measurements of machines drawn from the bounds that have one term more than the model, of 1.2 to
// 30 times its chi-square after the best fit without it, diagnoses each and prints what was found first, how
// often the 95 % intervals hold before and after, and the largest error in standard deviations. "scaled":
// before, with the residual's variance in the place of the noise's. "alike":
// cases in which some other term does the same to within what evidence could tell, and of these how many name
// the missing one among several. "second": how many of those that advise a test at another amplitude; of
// these, how many name the missing term when both tests are diagnosed together and no longer those that it
// was tied with ("apart"), and how many name it alone. Without terms: nothing missing, then each candidate
// that is visible at the centre of the box. "process.x": a random force on x, named where the diagnosis says
// so in the place of all terms, or of what remains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/diagnosis/augment.hpp"
#include "framework/diagnosis/candidates/observed_motion.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of many diagnoses with one term missing.
struct Tally {
  int tests = 0, first = 0, tied = 0, nothing = 0;
  int alike = 0, alike_named = 0, advised = 0, apart = 0, alone = 0;
  std::map<std::string, int> found;
  VectorXd held_before, held_after;  ///< p, counts
  VectorXd held_scaled;              ///< of `before`, with the noise taken to be as large as the residual
  int counted_before = 0, counted_after = 0;
  double worst_before = 0.0, worst_after = 0.0, seconds = 0.0;
  std::vector<double> ratios;
};

class Study {
 public:
  Study(const std::string& file, std::uint64_t seed)
      : experiment_(followNoise(readExperimentWithSignals(loadExperimentTree(file)))),
        layout_(makeLayout(experiment_)),
        extractor_(makeExtractor(experiment_, layout_)),
        noise_(experiment_.noise, layout_),
        random_(seed, RandomPurpose::kTestDesign),
        seed_(seed),
        shared_(static_cast<Index>(experiment_.model.parameters.size())) {}

  std::vector<std::string> listVisible() const {
    std::vector<std::string> terms{"none"};
    const ScoredCandidates scored = score(calcBoxCenter(collectUnknown(experiment_.model)));
    for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
      const std::string& term = scored.candidates[i].term;
      if (scored.scores[i].visible && terms.back() != term) {
        terms.push_back(term);
      }
    }
    for (const ForcedCoordinate& coordinate : listForcedCoordinates(experiment_.model.system)) {
      terms.push_back("process." + coordinate.name);
    }
    return terms;
  }

  Tally run(const std::string& term, int tests) const {
    Tally tally;
    tally.held_before = tally.held_after = tally.held_scaled = VectorXd::Zero(shared_);
    const int first = calcFirstTest(term);
    for (int test = 0; test < tests; ++test) {
      measureAndDiagnose(term, first + test, tally);
    }
    return tally;
  }

 private:
  /// Tests of two terms are of other machines and noise: else their coverages would err together.
  static int calcFirstTest(const std::string& term) {
    constexpr int kApart = 1000;
    int hash = 0;  // the same on every machine
    for (const char letter : term) {
      hash = (31 * hash + static_cast<unsigned char>(letter)) % 100003;
    }
    return kApart * hash;
  }

  double drawUniform(int test, Index channel) const {
    return random_.calcUniform(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(channel));
  }

  ScoredCandidates score(const VectorXd& point) const {
    const RecordedFeatures empty{layout_, {VectorXd::Zero(extractor_.getFeatureCount())}, {}};
    return scoreCandidates(experiment_, empty, point);
  }

  /// Whether a term of this size cannot be told from another, by the linear model.
  static bool isAlike(const ScoredCandidates& scored, std::size_t chosen, double size) {
    constexpr double kTold = 2.0 * kTiedEvidence;  // of chi-square
    const auto at = static_cast<Index>(chosen);
    const double whole = size * scored.test->calcLength(at);
    for (std::size_t k = 0; k < scored.candidates.size(); ++k) {
      const double likeness = scored.test->calcLikeness(at, static_cast<Index>(k));
      if (scored.candidates[k].term != scored.candidates[chosen].term && scored.scores[k].visible &&
          whole * whole * (1.0 - likeness * likeness) < kTold) {
        return true;
      }
    }
    return false;
  }

  double drawRatio(int test) const {
    return std::exp(std::log(1.2) + drawUniform(test, 100) * std::log(25.0));
  }

  /// A force on a coordinate that forgets itself: Ornstein and Uhlenbeck's, linear between 100 knots.
  TermCandidate makeGust(const std::string& coordinate, int test) const {
    constexpr int kKnots = 101;
    constexpr Index kChannel = 1000;
    const double interval = experiment_.model.simulation.duration / (kKnots - 1);
    const double forgets = std::exp(-1.0 / (2.0 + 8.0 * drawUniform(test, 101)));  // within 2 to 10 knots
    TableSpec table;
    double value = 0.0;
    for (int i = 0; i < kKnots; ++i) {
      const double step =
          random_.calcNormal(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(kChannel + i));
      value = i == 0 ? step : forgets * value + std::sqrt(1.0 - forgets * forgets) * step;
      table.times.push_back(interval * i);
      table.values.push_back(value);
    }
    TermCandidate gust;
    gust.term = "process." + coordinate;
    gust.add = [coordinate, table](ModelSpec& model, const std::string& coefficient,
                                   const std::vector<std::string>&) {
      SignalSpec signal;
      signal.name = {"gust", {}};
      signal.unit = "1";
      signal.tables.push_back(table);
      model.excitation.push_back(signal);
      ForceLaw<Expression> law;
      law.coordinate = {coordinate, {}};
      law.force = {coefficient + "*gust", {}};
      model.system.elements.get<ForceLaw>().push_back(law);
    };
    return gust;
  }

  AugmentedExperiment makeGustyMachine(const std::string& term, int test, VectorXd& point) const {
    const TermCandidate gust = makeGust(term.substr(term.find('.') + 1), test);
    const RecordedFeatures empty = makeEmptyRecordings(experiment_, {});
    const LinearizedRecordings linear = RecordingsProblem(addAll(experiment_, {gust}).experiment, empty)
                                            .linearize(insertAdded(point, shared_, VectorXd::Zero(1)));
    MatrixXd others(linear.jacobian.rows(), linear.jacobian.cols() - 1);
    others << linear.jacobian.leftCols(shared_), linear.jacobian.rightCols(others.cols() - shared_);
    const ScoreTest score(linear.residual, others, linear.jacobian.col(shared_));
    const double size = std::sqrt((drawRatio(test) - 1.0) * static_cast<double>(linear.residual.size())) *
                        score.calcScore(0, kInfinity).stddev;
    point = insertAdded(point, shared_, VectorXd::Constant(1, size));
    return addTerm(experiment_, gust, 2.0 * size);
  }

  /// The machine with the term, and its point; the model itself for "none". The ratio of chi-square follows a
  /// log-uniform distribution.
  AugmentedExperiment makeMachine(const std::string& term, int test, VectorXd& point, bool& is_alike) const {
    if (term == "none") {
      return {experiment_, 0};
    }
    if (isProcess(term)) {
      return makeGustyMachine(term, test, point);
    }
    const ScoredCandidates scored = score(point);
    std::vector<std::size_t> scales;
    for (std::size_t i = 0; i < scored.candidates.size(); ++i) {
      if (scored.candidates[i].term == term && scored.scores[i].visible) {
        scales.push_back(i);
      }
    }
    if (scales.empty()) {
      throw std::runtime_error(term + " is not visible");
    }
    const std::size_t chosen = scales[scales.size() / 2];
    const double size =
        std::sqrt((drawRatio(test) - 1.0) * static_cast<double>(extractor_.getFeatureCount())) *
        scored.scores[chosen].stddev;
    is_alike = isAlike(scored, chosen, size);
    AugmentedExperiment machine = addTerm(experiment_, scored.candidates[chosen], 2.0 * size);
    VectorXd added(machine.added);
    added[0] = size;
    for (Index i = 1; i < machine.added; ++i) {
      const OwnScale& scale = scored.candidates[chosen].own_scales[static_cast<std::size_t>(i) - 1];
      const double factor = std::exp(drawUniform(test, 100 + i) - 0.5);
      added[i] = scale.value * std::clamp(factor, 1.0 / scale.reach, scale.reach);
    }
    point = insertAdded(point, shared_, added);
    return machine;
  }

  void measureAndDiagnose(const std::string& term, int test, Tally& tally) const {
    const std::vector<ParameterSpec> unknown = collectUnknown(experiment_.model);
    VectorXd point = calcLowerBounds(unknown);
    for (Index j = 0; j < point.size(); ++j) {
      point[j] += calcWidths(unknown)[j] * (0.15 + 0.7 * drawUniform(test, j));
    }
    const VectorXd truth = point.head(shared_);
    bool is_alike = false;
    const AugmentedExperiment machine = makeMachine(term, test, point, is_alike);
    const std::optional<VectorXd> measured = measure(machine.experiment, point, test, 0);
    if (!measured) {
      return;
    }
    const RecordedFeatures recordings{layout_, {*measured}, {}};
    const std::clock_t begin = std::clock();
    const Diagnosis diagnosis = diagnose(experiment_, recordings, {});
    tally.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    count(diagnosis, term, truth, tally);
    const bool names = namesAmongTied(diagnosis, term);
    tally.alike += is_alike ? 1 : 0;
    tally.alike_named += is_alike && names && diagnosis.steps.front().tied > 1 ? 1 : 0;
    double factor = 0.0;
    if (names && diagnosis.steps.front().tied > 1 &&
        std::sscanf(diagnosis.steps.front().advice.c_str(), "a second test at %lf times", &factor) == 1) {
      ++tally.advised;
      countSecond(diagnosis, diagnoseBoth(machine.experiment, point, test, *measured, factor), term, tally);
    }
  }

  /// The features of a machine; none where it cannot be simulated.
  std::optional<VectorXd> measure(const ExperimentSpec& machine, const VectorXd& point, int test,
                                  int repeat) const {
    const std::unique_ptr<Simulator> simulator =
        makeTrustedSimulator(machine.model, layout_.times, layout_.modes);
    MatrixXd response(layout_.getRowCount(), 1);
    SampleStatus status;
    simulator->simulate(point, response, &status);
    if (!status.ok) {
      return {};
    }
    const MatrixXd noisy =
        addNoise(response, noise_,
                 {seed_ + 1000 * static_cast<std::uint64_t>(test) + static_cast<std::uint64_t>(repeat),
                  RandomPurpose::kTestNoise});
    return extractor_.extract(noisy).col(0);
  }

  /// Of the test that was made and one with all signals `factor` times as large.
  std::optional<Diagnosis> diagnoseBoth(ExperimentSpec machine, const VectorXd& point, int test,
                                        const VectorXd& first, double factor) const {
    scaleSignals(machine.model, factor);
    const std::optional<VectorXd> second = measure(machine, point, test, 500);
    if (!second) {
      return {};
    }
    ExperimentSpec larger = experiment_;
    scaleSignals(larger.model, factor);
    const ExperimentSpec both = combineTrials(experiment_, {{"first", experiment_}, {"second", larger}});
    RecordedFeatures recordings = makeEmptyRecordings(both, {});
    recordings.features = {first, *second};
    return diagnose(both, recordings, {});
  }

  static void countSecond(const Diagnosis& one, const std::optional<Diagnosis>& both, const std::string& term,
                          Tally& tally) {
    if (!both || !namesAmongTied(*both, term)) {
      return;
    }
    const DiagnosisStep& step = one.steps.front();
    bool apart = true;
    for (std::size_t i = 0; i < step.tied; ++i) {
      const std::string& other = step.ranked[i].candidate.term;
      apart = apart && (other == term || !namesAmongTied(*both, other));
    }
    tally.apart += apart ? 1 : 0;
    tally.alone += both->steps.front().tied == 1 ? 1 : 0;
  }

  static bool isProcess(const std::string& term) { return term.rfind("process.", 0) == 0; }

  static bool namesAmongTied(const Diagnosis& diagnosis, const std::string& term) {
    if (diagnosis.found == 0) {
      return false;
    }
    const DiagnosisStep& step = diagnosis.steps.front();
    return std::any_of(step.ranked.begin(), step.ranked.begin() + static_cast<long>(step.tied),
                       [&](const TermFinding& one) { return one.candidate.term == term; });
  }

  static bool namesProcess(const Diagnosis& diagnosis, const std::string& term) {
    const std::string what = "a force on " + term.substr(term.find('.') + 1);
    return (diagnosis.process && diagnosis.process->what == what) ||
           (diagnosis.found == 0 && diagnosis.remainder && diagnosis.remainder->what == what);
  }

  void count(const Diagnosis& diagnosis, const std::string& term, const VectorXd& truth, Tally& tally) const {
    ++tally.tests;
    const SimulatorPosterior& before = diagnosis.before.posterior;
    tally.ratios.push_back(before.chi_square / before.degrees);
    if (diagnosis.found == 0) {
      ++tally.nothing;
      ++tally.found["-"];
    } else {
      const DiagnosisStep& step = diagnosis.steps.front();
      const std::string& first = step.ranked.front().candidate.term;
      ++tally.found[first];
      tally.first += first == term ? 1 : 0;
    }
    tally.tied +=
        namesAmongTied(diagnosis, term) || (isProcess(term) && namesProcess(diagnosis, term)) ? 1 : 0;
    if (before.isReliable()) {
      compare({before.mean.head(shared_), before.stddev.head(shared_), before.draws.topRows(shared_),
               before.weights},
              truth, tally.held_before, tally.counted_before, tally.worst_before);
      countScaled(before, truth, tally.held_scaled);
    }
    if (isProcess(term)) {
      compareProcess(diagnosis, truth, tally);
    } else if (diagnosis.averaged.isGiven()) {
      compare(diagnosis.averaged, truth, tally.held_after, tally.counted_after, tally.worst_after);
    }
  }

  /// As a fit without a known noise has them: standard deviations by the residual's variance.
  void countScaled(const SimulatorPosterior& before, const VectorXd& truth, VectorXd& held) const {
    const double scale = std::sqrt(before.chi_square / before.degrees);
    for (Index j = 0; j < shared_; ++j) {
      held[j] += std::abs(before.mean[j] - truth[j]) < 1.96 * scale * before.stddev[j] ? 1.0 : 0.0;
    }
  }

  /// With the process in the place of terms: normal.
  void compareProcess(const Diagnosis& diagnosis, const VectorXd& truth, Tally& tally) const {
    const std::optional<Remainder>& process = diagnosis.process ? diagnosis.process : diagnosis.remainder;
    if (!process || process->findOutside(experiment_.model.parameters) >= 0) {
      return;
    }
    ++tally.counted_after;
    for (Index j = 0; j < shared_; ++j) {
      const double z = std::abs(process->mean[j] - truth[j]) / process->stddevs[j];
      tally.held_after[j] += z < 1.96 ? 1.0 : 0.0;
      tally.worst_after = std::max(tally.worst_after, z);
    }
  }

  void compare(const AveragedEstimate& posterior, const VectorXd& truth, VectorXd& held, int& counted,
               double& worst) const {
    ++counted;
    const MatrixXd quantiles = posterior.calcQuantiles(Eigen::Vector2d(0.025, 0.975));
    for (Index j = 0; j < shared_; ++j) {
      held[j] += quantiles(j, 0) <= truth[j] && truth[j] <= quantiles(j, 1) ? 1.0 : 0.0;
      worst = std::max(worst, std::abs(posterior.mean[j] - truth[j]) / posterior.stddev[j]);
    }
  }

  const ExperimentSpec experiment_;
  const ResponseLayout layout_;
  const FeatureExtractor extractor_;
  const ResponseNoise noise_;
  const RandomStream random_;
  const std::uint64_t seed_;
  const Index shared_;
};

std::string describeHeld(const VectorXd& held, int counted) {
  std::string text;
  for (const double count : held) {
    text += fmt::format("{}{:.2f}", text.empty() ? "" : " ", count / std::max(1, counted));
  }
  return text;
}

void print(const std::string& term, Tally tally) {
  std::vector<std::pair<std::string, int>> found(tally.found.begin(), tally.found.end());
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string names;
  for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 3); ++i) {
    names += fmt::format(" {} {}", found[i].first, found[i].second);
  }
  std::sort(tally.ratios.begin(), tally.ratios.end());
  const double ratio = tally.ratios.empty() ? 0.0 : tally.ratios[tally.ratios.size() / 2];
  fmt::print(
      "{:28} {:3} chi2/n {:5.2f} first {:3} tied {:3} nothing {:3} alike {}/{} second {} apart {} alone "
      "{} | held {} -> {} "
      "| "
      "worst z {:.0f} -> {:.1f} | {:.2f} s | scaled {} |{}\n",
      term, tally.tests, ratio, tally.first, tally.tied, tally.nothing, tally.alike_named, tally.alike,
      tally.advised, tally.apart, tally.alone, describeHeld(tally.held_before, tally.counted_before),
      describeHeld(tally.held_after, tally.counted_after), tally.worst_before, tally.worst_after,
      tally.seconds / std::max(1, tally.tests), describeHeld(tally.held_scaled, tally.counted_before), names);
  std::fflush(stdout);
}

int run(int count, char** arguments) {
  if (count < 2) {
    fmt::print("usage: diagnosis_study FILE.yaml [tests] [seed] [TERM ...]\n");
    return 2;
  }
  const int tests = count > 2 ? std::atoi(arguments[2]) : 20;
  const Study study(arguments[1], count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 1);
  std::vector<std::string> terms(arguments + std::min(count, 4), arguments + count);
  if (terms.empty()) {
    terms = study.listVisible();
  }
  for (const std::string& term : terms) {
    try {
      print(term, study.run(term, tests));
    } catch (const std::exception& error) {
      fmt::print("{:28} {}\n", term, error.what());
    }
  }
  return 0;
}

}  // namespace
}  // namespace twinmap

int main(int count, char** arguments) {
  return twinmap::run(count, arguments);
}
