// How often a diagnosis names the term that a model lacks:
//   diagnosis_study FILE.yaml [tests] [seed] [TERM ...]
// simulates measurements of machines drawn from the bounds that have one term more than the model, of 1.2 to
// 30 times its chi-square after the best fit without it, diagnoses each and prints what was found first, how
// often the 95 % intervals hold before and after, and the largest error in standard deviations. Without
// terms: nothing missing, then each candidate that is visible at the centre of the box.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <set>
#include <string>

#include "framework/base/random/random.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
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
  std::map<std::string, int> found;
  VectorXd held_before, held_after;  ///< p, counts
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
    return terms;
  }

  Tally run(const std::string& term, int tests) const {
    Tally tally;
    tally.held_before = tally.held_after = VectorXd::Zero(shared_);
    for (int test = 0; test < tests; ++test) {
      measureAndDiagnose(term, test, tally);
    }
    return tally;
  }

 private:
  double drawUniform(int test, Index channel) const {
    return random_.calcUniform(static_cast<std::uint64_t>(test), static_cast<std::uint64_t>(channel));
  }

  ScoredCandidates score(const VectorXd& point) const {
    const RecordedFeatures empty{layout_, {VectorXd::Zero(extractor_.getFeatureCount())}, {}};
    return scoreCandidates(experiment_, empty, point);
  }

  /// The machine with the term, and its point; the model itself for "none". The ratio of chi-square follows a
  /// log-uniform distribution.
  AugmentedExperiment makeMachine(const std::string& term, int test, VectorXd& point) const {
    if (term == "none") {
      return {experiment_, 0};
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
    const double ratio = std::exp(std::log(1.2) + drawUniform(test, 100) * std::log(30.0 / 1.2));
    const double size = std::sqrt((ratio - 1.0) * static_cast<double>(extractor_.getFeatureCount())) *
                        scored.scores[chosen].stddev;
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
    const AugmentedExperiment machine = makeMachine(term, test, point);
    const std::unique_ptr<Simulator> simulator =
        makeTrustedSimulator(machine.experiment.model, layout_.times, layout_.modes);
    MatrixXd response(layout_.getRowCount(), 1);
    SampleStatus status;
    simulator->simulate(point, response, &status);
    if (!status.ok) {
      return;
    }
    const MatrixXd noisy = addNoise(
        response, noise_, {seed_ + 1000 * static_cast<std::uint64_t>(test), RandomPurpose::kTestNoise});
    const RecordedFeatures recordings{layout_, {extractor_.extract(noisy).col(0)}, {}};
    DiagnosisOptions options;
    const std::clock_t begin = std::clock();
    count(diagnose(experiment_, recordings, options), term, truth, tally);
    tally.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
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
      tally.tied += std::any_of(step.ranked.begin(), step.ranked.begin() + static_cast<long>(step.tied),
                                [&](const TermFinding& one) { return one.candidate.term == term; })
                        ? 1
                        : 0;
    }
    if (before.isReliable()) {
      compare({before.mean.head(shared_), before.stddev.head(shared_), before.draws.topRows(shared_),
               before.weights},
              truth, tally.held_before, tally.counted_before, tally.worst_before);
    }
    if (diagnosis.averaged.isGiven()) {
      compare(diagnosis.averaged, truth, tally.held_after, tally.counted_after, tally.worst_after);
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
      "{:28} {:3} chi2/n {:5.2f} first {:3} tied {:3} nothing {:3} | held {} -> {} | worst z {:.0f} -> "
      "{:.1f} | {:.2f} s |{}\n",
      term, tally.tests, ratio, tally.first, tally.tied, tally.nothing,
      describeHeld(tally.held_before, tally.counted_before),
      describeHeld(tally.held_after, tally.counted_after), tally.worst_before, tally.worst_after,
      tally.seconds / std::max(1, tally.tests), names);
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
