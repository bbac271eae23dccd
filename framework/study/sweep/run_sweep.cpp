#include "framework/study/sweep/run_sweep.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/folder_lock.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/log/log_context.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/report/sections/report.hpp"
#include "framework/results/run_state.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/pipeline/training/choose_samples.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/sweep/run_cases.hpp"
#include "framework/study/sweep/shared_samples.hpp"
#include "framework/study/sweep/sweep_tables.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

}  // namespace

void limitAutomaticSamples(std::vector<SweepCase>& cases) {
  if (std::none_of(cases.begin(), cases.end(),
                   [](const SweepCase& one) { return one.experiment.design.train.samples.automatic; })) {
    return;
  }
  for (const ModelGroup& group : groupByModel(cases)) {
    std::unique_ptr<Simulator> simulator;
    for (const int member : group.cases) {
      SampleCount& samples = cases[static_cast<std::size_t>(member)].experiment.design.train.samples;
      if (samples.automatic && samples.number > 0) {
        simulator = simulator ? std::move(simulator) : makeSimulator(group.model, group.times, group.modes);
        samples.number = limitByTime(cases[static_cast<std::size_t>(member)].experiment, *simulator);
      }
    }
  }
}

namespace {

class Sweep {
 public:
  /// `wanted`, one a case: those that are to be run; empty: all.
  Sweep(std::vector<std::string> keys, std::vector<SweepCase> cases, std::vector<bool> wanted,
        const SweepOptions& options, const RunControl& control)
      : keys_(std::move(keys)),
        cases_(std::move(cases)),
        options_(options),
        control_(control),
        complete_(findComplete(options.folder, cases_)),
        wanted_(wanted.empty() ? std::vector<bool>(cases_.size(), true) : std::move(wanted)),
        store_(getStoreRoot(options.folder, options.store)),
        samples_of_case_(cases_.size()),
        stencils_of_case_(cases_.size(), nullptr) {
    result_.cases = static_cast<int>(cases_.size());
    result_.skipped = static_cast<int>(std::count(complete_.begin(), complete_.end(), true));
    logInfo(fmt::format("{} cases, {} of them complete", result_.cases, result_.skipped));
  }

  /// The samples, then, of models without derivatives, the stencils of those that did not fail. False
  /// if it was stopped.
  bool simulate() {
    std::vector<bool> wanted = wanted_;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      wanted[i] = wanted[i] && !complete_[i];
    }
    const std::vector<ModelGroup> groups = groupByModel(cases_);
    for (const ModelGroup& group : groups) {
      addSamples(group, collectPoints(cases_, group, wanted));
    }
    if (!simulateAll(samples_, "samples", {"simulate", 1})) {
      return false;
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (const ModelGroup& part : splitByBounds(cases_, groups[i])) {
        addStencils(part, collectDerivativePoints(cases_, part, wanted), samples_[i]);
      }
    }
    const std::size_t unknown = collectUnknown(cases_[0].experiment.model).size();
    return stencils_.empty() || simulateAll(stencils_, "stencils", {kStencilStage, countNeighbours(unknown)});
  }

  void runMissingCases() {
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      if (!complete_[i] && wanted_[i]) {
        todo_.push_back(static_cast<int>(i));
        costs_.push_back(calcCaseCost(cases_[i].experiment, 1));
        work_ += costs_.back().flops;
      }
    }
    CaseScheduling scheduling{control_.threads, options_.memory, options_.fail_fast, control_.stop, {}};
    scheduling.finished = [this](int index, const CaseOutcome& outcome) { noteFinished(index, outcome); };
    runCases(costs_, scheduling, [this](int index, int threads) { runCase(todo_[index], threads); });
  }

  /// What was found, without tables.
  SweepResult getResult() {
    result_.complete = static_cast<int>(std::count(complete_.begin(), complete_.end(), true));
    result_.stopped = control_.stop != nullptr && *control_.stop && countLeft() > 0;
    return result_;
  }

  void addFailures(const std::vector<FailedCase>& failures) {
    for (const FailedCase& failure : failures) {
      if (!complete_[findCase(failure)]) {
        result_.failures.push_back(failure);
      }
    }
  }

  SweepResult finish() {
    getResult();
    std::sort(result_.failures.begin(), result_.failures.end(),
              [this](const FailedCase& a, const FailedCase& b) { return findCase(a) < findCase(b); });
    writeFailedCases(options_.folder, result_.failures);
    result_.table = writeSweepTables(options_.folder, keys_, cases_, complete_);
    if (result_.complete > 0) {
      const Report report = makeReport({options_.folder});
      writeReport(options_.folder, report);
      result_.gates = report.gates;
    }
    return result_;
  }

 private:
  /// Wanted cases that are neither complete nor failed.
  int countLeft() const {
    int left = -static_cast<int>(result_.failures.size());
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      left += wanted_[i] && !complete_[i] ? 1 : 0;
    }
    return left;
  }

  void addSamples(const ModelGroup& group, const Eigen::MatrixXd& points) {
    for (const int member : group.cases) {
      samples_of_case_[member] = samples_.size();
    }
    samples_.push_back(points.cols() > 0 ? openSharedSamples(group, points, store_) : SharedSamples{});
  }

  void addStencils(const ModelGroup& group, const Eigen::MatrixXd& points, const SharedSamples& samples) {
    if (points.cols() == 0 || samples.store == nullptr || samples.simulator->hasDerivatives()) {
      return;
    }
    stencils_.push_back(openSharedStencils(group, points, samples, store_));
    for (const int member : group.cases) {
      stencils_of_case_[member] = stencils_.back().store.get();
    }
  }

  struct Stage {
    std::string name;
    int simulations;  ///< behind each sample
  };

  /// False if it was stopped.
  bool simulateAll(std::vector<SharedSamples>& groups, const std::string& what, const Stage& stage) const {
    constexpr double kShare = 0.25;  // of the memory: the responses of one block, as simulated and as stored
    const auto start = std::chrono::steady_clock::now();
    const SimulationProgress done =
        simulateShared(groups, {kShare * options_.memory, stage.name, stage.simulations}, control_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    logInfo(fmt::format("{} of {} missing {} simulated in {:.2f} s, {} of them failed", done.simulated,
                        done.total, what, elapsed.count(), done.failed));
    return done.simulated + done.given_up == done.total;
  }

  void runCase(int index, int threads) const {
    const SweepCase& one = cases_[index];
    const LogContext context(one.name);
    const SharedSamples& samples = samples_[samples_of_case_[index]];
    RunOptions run;
    run.folder = getCaseFolder(options_.folder, one);
    run.command = options_.command;
    if (!samples.failure.empty()) {
      makeFolders(run.folder);
      beginRun(run.folder, writeExperiment(one.experiment));
      throw std::runtime_error(samples.failure);
    }
    const SampleSource source{*samples.simulator, *samples.store, stencils_of_case_[index]};
    run.samples = &source;
    runExperiment(one.experiment, run, {threads, nullptr, control_.abandon, nullptr});
  }

  void noteFinished(int index, const CaseOutcome& outcome) {
    const SweepCase& one = cases_[todo_[index]];
    ++finished_;
    finished_work_ += costs_[index].flops;
    if (outcome.status == CaseStatus::kDone) {
      complete_[todo_[index]] = true;
      logInfo(fmt::format("case {} is complete", one.name));
    } else {
      const fs::path folder = getCaseFolder(options_.folder, one);
      result_.failures.push_back({one.name, outcome.reason, makeCaseCommand(folder, store_)});
      if (todo_.size() == static_cast<std::size_t>(result_.cases - result_.skipped)) {  // else it is a part
        writeFailedCases(options_.folder, result_.failures);
      }
      logError(fmt::format("case {} failed: {}", one.name, outcome.reason));
    }
    if (control_.progress) {
      control_.progress({"cases", finished_, static_cast<int>(todo_.size()),
                         static_cast<int>(result_.failures.size()), finished_work_ / work_, false});
    }
  }

  std::size_t findCase(const FailedCase& failure) const {
    return std::find_if(cases_.begin(), cases_.end(),
                        [&](const SweepCase& one) { return one.name == failure.name; }) -
           cases_.begin();
  }

  const std::vector<std::string> keys_;  ///< that are swept
  const std::vector<SweepCase> cases_;
  const SweepOptions& options_;
  const RunControl& control_;
  std::vector<bool> complete_, wanted_;
  fs::path store_;
  std::vector<std::size_t> samples_of_case_;  ///< indices of samples_
  std::vector<SharedSamples> samples_, stencils_;
  std::vector<TrajectoryStore*> stencils_of_case_;  ///< null: the case needs none
  std::vector<int> todo_;                           ///< cases that were not complete
  std::vector<CaseCost> costs_;
  double work_ = 0.0, finished_work_ = 0.0;
  int finished_ = 0;
  SweepResult result_;
};

}  // namespace

SweepResult runSweep(const YamlNode& root, const SweepOptions& options, const RunControl& control) {
  std::vector<SweepCase> cases = expandCasesWithSignals(root);
  for (const SweepCase& one : cases) {
    requireAllSamples(one.experiment, "a sweep, whose cases share their simulations,");
    requireMemory(one.experiment, 1, options.most_memory);
  }
  makeFolders(options.folder);
  const FolderLock lock(options.folder);
  beginSweep(root, options);
  const RunLog log(options.folder);
  logInfo(options.command);

  followNoise(cases);
  limitAutomaticSamples(cases);
  Sweep sweep(listSweptKeys(root), std::move(cases), {}, options, control);
  if (sweep.simulate()) {
    sweep.runMissingCases();
  }
  return sweep.finish();
}

SweepResult runCasesOfSweep(const std::vector<std::string>& keys, const std::vector<SweepCase>& cases,
                            const std::vector<bool>& wanted, const SweepOptions& options,
                            const RunControl& control) {
  Sweep sweep(keys, cases, wanted, options, control);
  if (sweep.simulate()) {
    sweep.runMissingCases();
  }
  return sweep.getResult();
}

SweepResult finishSweep(const std::vector<std::string>& keys, const std::vector<SweepCase>& cases,
                        const std::vector<FailedCase>& failures, const SweepOptions& options,
                        const RunControl& control) {
  Sweep sweep(keys, cases, {}, options, control);
  sweep.addFailures(failures);
  return sweep.finish();
}

void beginSweep(const YamlNode& root, const SweepOptions& options) {
  const std::string resolved = writeIndependentDefaults(root);
  makeFolders(options.folder);
  requireSameExperiment(options.folder, resolved);
  writeTextFile(options.folder / "resolved.yaml", resolved);
  noteStore(options.folder, options.store);
}

}  // namespace twinmap
