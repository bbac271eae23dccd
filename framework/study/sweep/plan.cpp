#include "framework/study/sweep/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "framework/base/log/notice.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap {

namespace fs = std::filesystem;

namespace {

constexpr double kNumber = 8.0, kSingle = 4.0;       // bytes
constexpr double kProgram = 40.0 * 1024.0 * 1024.0;  // bytes of a process without data
constexpr double kReport = 1.5 * 1024.0 * 1024.0;    // bytes of report, figures and texts of a case
constexpr double kPredictionRow = 90.0;              // bytes of a line of predictions.csv

double countTrainingColumns(const ExperimentSpec& e) {
  return double(e.design.train.samples) * e.noise.replicates.value_or(1);
}

double countSamples(const ExperimentSpec& e) {
  return double(e.design.train.samples) + e.design.test.samples;
}

double countParameters(const ExperimentSpec& e) {
  return static_cast<double>(e.model.parameters.size());
}

/// samples.h5, what is in maps.h5, and the tables. scores: of a window of reduced samples.
double calcCaseDisk(const ExperimentSpec& e, double scores) {
  const GpMapSpec* gp = e.inverse_map.findGp();  // a surrogate is small
  const bool sparse = gp != nullptr && gp->approximation == GpApproximation::kSgpr;
  const double order = gp == nullptr ? 0.0 : (sparse ? 1.5 * gp->inducing : countTrainingColumns(e));
  const double directions = isReduced(e) ? kSingle * scores * countRecordedRows(e) : 0.0;
  return kNumber * (countRows(e, scores) + double(countSampled(e.model))) * countSamples(e) +
         kNumber * countParameters(e) * order * order + directions +
         kPredictionRow * countParameters(e) * e.design.test.samples + kReport;
}

/// What the simulated samples take: of reduced ones what is kept.
double calcStoreDisk(const ExperimentSurvey& survey, double scores) {
  const ExperimentSpec& e = survey.cases.front().experiment;
  const double kept = isReduced(e) ? countRows(e, scores) / countRecordedRows(e) : 1.0;  // never of a sweep
  return kept * (survey.stored.samples.bytes + survey.stored.stencils.bytes);
}

/// What a case takes after its samples are simulated, in the order of a run.
std::vector<StageTime> calcStages(const ExperimentSpec& e, const ProbeTimes& times) {
  const double tests = e.design.test.samples;
  return {{"train", times.training.calcTraining(e)},
          {"calibrate", times.calcPreparation(e)},
          {"limit", e.evaluation.limit ? times.limit * tests : 0.0},
          {"refine", times.refinement * tests},  // 0 where nothing is refined
          {"test samples", times.evaluation * tests},
          {"rest", times.overhead}};
}

double calcCaseSeconds(const ExperimentSpec& e, const ProbeTimes& times) {
  const std::vector<StageTime> stages = calcStages(e, times);
  return std::accumulate(stages.begin(), stages.end(), 0.0,
                         [](double sum, const StageTime& stage) { return sum + stage.seconds; });
}

/// The time of a team that takes the longest first, and no less than the longest.
double calcTeamSeconds(const std::vector<double>& seconds, int threads) {
  if (seconds.empty()) {
    return 0.0;
  }
  const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return std::max(sum / threads, *std::max_element(seconds.begin(), seconds.end()));
}

/// Cases above their share of the memory count as sped up by all threads.
double calcCasesSeconds(const std::vector<SweepCase>& cases, const std::vector<bool>& todo,
                        const ProbeTimes& times, const PlanOptions& options) {
  std::vector<double> side_by_side;
  double alone = 0.0;
  const bool single = cases.size() == 1;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!todo[i]) {
      continue;
    }
    const double seconds = calcCaseSeconds(cases[i].experiment, times);
    if (single || calcCaseCost(cases[i].experiment, 1).bytes > options.memory / options.threads) {
      alone += times.overhead + (seconds - times.overhead) / options.threads;
    } else {
      side_by_side.push_back(seconds);
    }
  }
  return alone + calcTeamSeconds(side_by_side, options.threads);
}

/// The cases that need most, as many as run at the same time, or the largest alone; or what is simulated
/// before.
double calcMemory(const std::vector<SweepCase>& cases, const std::vector<bool>& todo,
                  const PlanOptions& options, const StoredCounts& stored) {
  constexpr double kShare = 0.25, kCopies = 2.0;  // of a block of responses (runSweep)
  std::vector<double> bytes;
  double alone =
      kCopies * std::min(kShare * options.memory, std::max(stored.samples.bytes, stored.stencils.bytes));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (todo[i]) {
      const double one = calcCaseCost(cases[i].experiment, 1).bytes;
      const bool fits = cases.size() > 1 && one <= options.memory / options.threads;
      fits ? bytes.push_back(one)
           : void(alone = std::max(alone, calcCaseCost(cases[i].experiment, options.threads).bytes));
    }
  }
  std::sort(bytes.rbegin(), bytes.rend());
  const auto together = std::min<std::size_t>(bytes.size(), static_cast<std::size_t>(options.threads));
  return kProgram + std::max(alone, std::accumulate(bytes.begin(), bytes.begin() + together, 0.0));
}

void warnAboutPlainDesigns(const std::vector<SweepCase>& cases, SweepPlan& plan) {
  std::set<int> train, test;
  for (const SweepCase& one : cases) {
    const DesignSpec& design = one.experiment.design;
    if (design.train.method == DesignMethod::kLatinHypercube) {
      train.insert(design.train.samples);
    }
    if (design.test.method == DesignMethod::kLatinHypercube) {
      test.insert(design.test.samples);
    }
  }
  for (const auto& [set, sizes] : {std::pair("train", train), {"test", test}}) {
    if (sizes.size() > 1) {
      plan.warnings.push_back(describeNotice(Notice::kPlainSweep, set, sizes.size()));
    }
  }
}

void noteAutomaticSamples(const std::vector<SweepCase>& cases, SweepPlan& plan) {
  for (const SweepCase& one : cases) {
    if (one.experiment.inverse_map.isNone()) {
      plan.warnings.emplace_back(
          "inverse_map is none: nothing is trained; each test sample is answered by its posterior on the "
          "simulator");
      return;
    }
    if (one.experiment.design.train.samples.automatic) {
      plan.warnings.push_back(fmt::format(
          "design.train.samples is automatic: all figures are for {} training samples, the most there may be",
          one.experiment.design.train.samples.number));
      return;
    }
  }
}

std::vector<bool> findCompleteCases(const std::vector<SweepCase>& cases,
                                    const std::filesystem::path& folder) {
  return cases.front().name.empty() ? std::vector<bool>{isComplete(folder)} : findComplete(folder, cases);
}

std::vector<bool> findTodo(const ExperimentSurvey& survey) {
  std::vector<bool> todo = survey.complete;
  todo.flip();
  return todo;
}

/// The case with the most work stands for all.
const ExperimentSpec& findLargest(const std::vector<SweepCase>& cases) {
  return std::max_element(cases.begin(), cases.end(),
                          [](const SweepCase& a, const SweepCase& b) {
                            return calcCaseCost(a.experiment, 1).flops < calcCaseCost(b.experiment, 1).flops;
                          })
      ->experiment;
}

/// Two digits, without an exponent.
std::string describeRoughly(double value) {
  const double unit = value >= 100.0 ? std::pow(10.0, std::floor(std::log10(value)) - 1.0) : 0.0;
  return unit > 0.0 ? fmt::format("{:.0f}", std::round(value / unit) * unit) : fmt::format("{:.2g}", value);
}

std::string describeSeconds(double seconds) {
  constexpr double kMinute = 60.0, kHour = 3600.0;
  if (seconds < 2.0 * kMinute) {
    return describeRoughly(seconds) + " s";
  }
  return seconds < 2.0 * kHour ? describeRoughly(seconds / kMinute) + " min"
                               : describeRoughly(seconds / kHour) + " h";
}

/// The time where the automatic choice ends with its second step.
void noteFewSamples(const ExperimentSurvey& survey, const PlanOptions& options, SweepPlan& plan) {
  constexpr int kFirst = 100, kSecond = 200;
  const ExperimentSpec& experiment = survey.cases.front().experiment;
  const SampleCount& samples = experiment.design.train.samples;
  if (survey.cases.size() == 1 && samples.automatic && samples.number > kSecond) {
    const double seconds = survey.times.training.calcTraining(takeTrainingSamples(experiment, kFirst)) +
                           calcCaseSeconds(takeTrainingSamples(experiment, kSecond), survey.times);
    plan.warnings.push_back(fmt::format("where {} training samples are enough the cases take about {}",
                                        kSecond, describeSeconds(seconds / options.threads)));
  }
}

void addTimes(const ExperimentSurvey& survey, const PlanOptions& options, SweepPlan& plan) {
  const ProbeTimes& times = survey.times;
  plan.no_times = times.failure;
  if (plan.no_times.empty()) {
    plan.simulate_s =
        (plan.stored.samples.missing * times.simulation + plan.stored.stencils.missing * times.stencil) /
        options.threads;
    plan.cases_s = calcCasesSeconds(survey.cases, findTodo(survey), times, options);
    plan.largest = calcStages(findLargest(survey.cases), times);
    noteFewSamples(survey, options, plan);
  }
}

/// Those of a hundredth of the whole or more.
std::string describeStages(const std::vector<StageTime>& stages) {
  constexpr double kShown = 0.01;
  double sum = 0.0;
  for (const StageTime& stage : stages) {
    sum += stage.seconds;
  }
  std::string text;
  for (const StageTime& stage : stages) {
    if (stage.seconds >= kShown * sum) {
      text += (text.empty() ? "" : ", ") + stage.stage + " " + describeSeconds(stage.seconds);
    }
  }
  return text;
}

std::string describeBytes(double bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return bytes < 1024.0 * kMebi ? describeRoughly(bytes / kMebi) + " MiB"
                                : describeRoughly(bytes / kMebi / 1024.0) + " GiB";
}

/// Bytes that may be written to the file system where `folder` lies or will lie; unlimited where it does not
/// say.
double findFreeDisk(fs::path folder) {
  folder = fs::absolute(folder);
  while (!fs::exists(folder) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  return error ? std::numeric_limits<double>::infinity() : static_cast<double>(space.available);
}

}  // namespace

ExperimentSurvey surveyCases(std::vector<SweepCase> cases, const ResultPlace& place) {
  ExperimentSurvey survey;
  survey.cases = std::move(cases);
  survey.folder = place.folder;
  survey.complete = findCompleteCases(survey.cases, place.folder);
  survey.stored = countStored(survey.cases, survey.complete, getStoreRoot(place.folder, place.store));
  survey.times.failure = "not measured";
  return survey;
}

void measureTimes(ExperimentSurvey& survey) {
  if (std::count(survey.complete.begin(), survey.complete.end(), false) > 0) {
    const ExperimentSpec& largest = findLargest(survey.cases);
    survey.times = measureProbe(largest, countTrainingColumns(largest));
  }
}

SweepPlan planRun(const ExperimentSurvey& survey, const PlanOptions& options) {
  const std::vector<bool> todo = findTodo(survey);
  SweepPlan plan;
  plan.cases = static_cast<int>(survey.cases.size());
  plan.complete = static_cast<int>(std::count(todo.begin(), todo.end(), false));
  plan.stored = survey.stored;
  warnAboutPlainDesigns(survey.cases, plan);
  noteAutomaticSamples(survey.cases, plan);
  if (plan.complete == plan.cases) {
    return plan;
  }
  const double scores = survey.times.scores > 0.0 ? survey.times.scores : double(kMostScores);
  plan.disk = calcStoreDisk(survey, scores);
  for (std::size_t i = 0; i < survey.cases.size(); ++i) {
    plan.disk += todo[i] ? calcCaseDisk(survey.cases[i].experiment, scores) : 0.0;
  }
  plan.memory = calcMemory(survey.cases, todo, options, plan.stored);
  addTimes(survey, options, plan);
  return plan;
}

std::string describePlan(const SweepPlan& plan, const PlanOptions& options) {
  const PointCounts &samples = plan.stored.samples, &stencils = plan.stored.stencils;
  std::string text = fmt::format("cases:       {}, {} of them complete\n", plan.cases, plan.complete) +
                     fmt::format("simulations: {} needed, {} stored, {} to do\n", samples.needed,
                                 samples.stored, samples.missing);
  if (stencils.needed > 0) {
    text += fmt::format(
        "limits:      finite differences at {} points needed, {} stored, {} to do: {} simulations\n",
        stencils.needed, stencils.stored, stencils.missing, stencils.simulations);
  }
  if (!plan.no_times.empty()) {
    text += "time:        not known: " + plan.no_times + "\n";
  } else {
    text += fmt::format("time:        about {}: {} to simulate, {} for the cases, on {} threads\n",
                        describeSeconds(plan.simulate_s + plan.cases_s), describeSeconds(plan.simulate_s),
                        describeSeconds(plan.cases_s), options.threads);
    text += fmt::format("             {} on one thread: {}\n",
                        plan.cases > 1 ? "the largest case" : "the case", describeStages(plan.largest));
  }
  text += fmt::format("memory:      about {}, of {} allowed\n", describeBytes(plan.memory),
                      describeBytes(options.memory)) +
          "disk:        about " + describeBytes(plan.disk) + "\n";
  for (const std::string& warning : plan.warnings) {
    text += "warning: " + warning + "\n";
  }
  return text;
}

void requireFit(const ExperimentSurvey& survey, const SweepPlan& plan, const PlanOptions& options,
                double most_memory) {
  const std::vector<bool> todo = findTodo(survey);
  const int threads = survey.cases.size() > 1 ? 1 : options.threads;
  for (std::size_t i = 0; i < survey.cases.size(); ++i) {
    if (todo[i]) {
      requireMemory(survey.cases[i].experiment, threads, most_memory);
    }
  }
  const ExperimentSpec& first = survey.cases.front().experiment;
  const double free = findFreeDisk(survey.folder);
  if (plan.disk > free) {
    throw ExperimentError({first.name.where.file, 0, 0, "design"}, "",
                          fmt::format("needs about {} of disk, of which {} are free at '{}'. Reduce the "
                                      "samples, or write to another disk (--out, --store)",
                                      describeBytes(plan.disk), describeBytes(free), survey.folder.string()));
  }
}

}  // namespace twinmap
