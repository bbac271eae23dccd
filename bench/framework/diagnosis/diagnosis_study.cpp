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
// so in the place of all terms, or of what remains. "coulomb.x+delay.F": both are missing; "tied": both are
// named.
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

#include "bench/framework/diagnosis/incomplete_machine.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

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
      : maker_(file, seed), experiment_(maker_.getModel()), shared_(maker_.getParameterCount()) {}

  std::vector<std::string> listTerms() const { return maker_.listTerms(); }

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

  void measureAndDiagnose(const std::string& term, int test, Tally& tally) const {
    const std::optional<IncompleteMachine> machine = maker_.make(term, test);
    const std::optional<VectorXd> measured =
        machine ? maker_.measure(machine->experiment, machine->point, test, 0) : std::optional<VectorXd>();
    if (!measured) {
      return;
    }
    const RecordedFeatures recordings{maker_.getLayout(), {*measured}, {}};
    const std::clock_t begin = std::clock();
    const Diagnosis diagnosis = diagnose(experiment_, recordings, {});
    tally.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    count(diagnosis, term, machine->point.head(shared_), tally);
    const bool names = namesAmongTied(diagnosis, term);
    tally.alike += machine->is_alike ? 1 : 0;
    tally.alike_named += machine->is_alike && names && diagnosis.steps.front().tied > 1 ? 1 : 0;
    double factor = 0.0;
    if (names && diagnosis.steps.front().tied > 1 &&
        std::sscanf(diagnosis.steps.front().advice.c_str(), "a second test at %lf times", &factor) == 1) {
      ++tally.advised;
      countSecond(diagnosis, diagnoseBoth(*machine, test, *measured, factor), term, tally);
    }
  }

  /// Of the test that was made and one with all signals `factor` times as large.
  std::optional<Diagnosis> diagnoseBoth(const IncompleteMachine& machine, int test, const VectorXd& first,
                                        double factor) const {
    ExperimentSpec driven = machine.experiment;
    scaleSignals(driven.model, factor);
    const std::optional<VectorXd> second = maker_.measure(driven, machine.point, test, 500);
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

  static bool namesAmongTied(const Diagnosis& diagnosis, const std::string& term) {
    if (diagnosis.found == 0) {
      return false;
    }
    const DiagnosisStep& step = diagnosis.steps.front();
    return std::any_of(step.ranked.begin(), step.ranked.begin() + static_cast<long>(step.tied),
                       [&](const TermFinding& one) { return one.candidate.term == term; });
  }

  /// Anywhere: as found, as tied with what was found, or as its rival.
  static bool namesAnywhere(const Diagnosis& diagnosis, const std::string& term) {
    const auto is_term = [&](const TermFinding& one) { return one.candidate.term == term; };
    const auto names = [&](const DiagnosisStep& step) {
      const auto tied = step.ranked.begin() + static_cast<long>(step.found ? step.tied : 0);
      return std::any_of(step.ranked.begin(), tied, is_term) || (step.partner && is_term(*step.partner)) ||
             std::any_of(step.rivals.begin(), step.rivals.end(),
                         [&](const TermRival& one) { return one.rival == term; });
    };
    return std::any_of(diagnosis.steps.begin(), diagnosis.steps.end(), names);
  }

  static bool names(const Diagnosis& diagnosis, const std::string& term) {
    const std::size_t plus = term.find('+');
    if (plus != std::string::npos) {
      return namesAnywhere(diagnosis, term.substr(0, plus)) &&
             namesAnywhere(diagnosis, term.substr(plus + 1));
    }
    return namesAmongTied(diagnosis, term) || (isProcess(term) && namesProcess(diagnosis, term));
  }

  static bool namesProcess(const Diagnosis& diagnosis, const std::string& term) {
    const std::string what = "a force on " + term.substr(term.find('.') + 1);
    const auto names = [&](const std::optional<Remainder>& one) {
      return one && (one->what == what ||
                     std::find(one->rivals.begin(), one->rivals.end(), what) != one->rivals.end());
    };
    return names(diagnosis.process) || (diagnosis.found == 0 && names(diagnosis.remainder));
  }

  void count(const Diagnosis& diagnosis, const std::string& term, const VectorXd& truth, Tally& tally) const {
    ++tally.tests;
    const SimulatorPosterior& before = diagnosis.before.posterior;
    tally.ratios.push_back(before.chi_square / before.degrees);
    if (diagnosis.found == 0) {
      ++tally.nothing;
      ++tally.found["-"];
    } else {
      const std::string& first = diagnosis.steps.front().ranked.front().candidate.term;
      const bool is_pair = term.find('+') != std::string::npos;
      ++tally.found[is_pair ? fmt::format("{}", fmt::join(diagnosis.listTerms(), "+")) : first];
      tally.first += first == term ? 1 : 0;
    }
    tally.tied += names(diagnosis, term) ? 1 : 0;
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

  const MachineMaker maker_;
  const ExperimentSpec& experiment_;
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
    terms = study.listTerms();
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
  try {
    return twinmap::run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print("{}: {}\n", count > 1 ? arguments[1] : "", error.what());
    return 1;
  }
}
