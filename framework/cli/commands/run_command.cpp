#include <fmt/core.h>

#include <iostream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/cli/progress_line.hpp"
#include "framework/cli/signals.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/results/tables.hpp"
#include "framework/results/warnings.hpp"
#include "framework/study/pipeline/require_model.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/run_sweep.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

/// `line` must outlive it.
RunControl makeControl(const RunArguments& arguments, ProgressLine& line) {
  const StopFlags flags = catchSignals();
  RunControl control{arguments.threads, &flags.stop, &flags.abandon, nullptr};
  if (!arguments.quiet) {
    control.progress = [&line](const Progress& progress) { line.update(progress); };
  }
  return control;
}

void runSingle(const ExperimentSpec& given, const RunArguments& arguments, const fs::path& folder) {
  const ExperimentSpec experiment = reduceLongRecord(given);
  requireMemory(experiment, arguments.threads, getMostMemory(arguments));
  requireModel(experiment);  // before the folder is touched
  ProgressLine line(arguments.quiet);
  RunOptions options;
  options.folder = folder;
  options.store = arguments.store;
  options.command = arguments.command_line;
  const RunSummary summary = runExperiment(experiment, options, makeControl(arguments, line));
  line.clear();
  std::cout << makeMarkdownTable(summary);
  if (!arguments.quiet) {
    std::cerr << "Bias, sd and MARE: mean, standard deviation and mean absolute value of the relative errors "
                 "of the test samples.\ncov.: true values within the interval. limit: smallest sd that the "
                 "noise permits. (..): standard error of the last digits.\n";
  }
  for (const std::string& warning : collectWarnings(summary)) {
    std::cerr << "twinmap: " << (isRemark(warning) ? "" : "warning: ") << warning << "\n";
  }
  std::cerr << "Report: " << (options.folder / "report.html").string() << "\n";
  requireGates(summary.gates, arguments.fail_on_gates);
}

/// Its memory does not grow with the samples, so that none is asked for.
void runFeaturesOnly(const ExperimentSpec& experiment, const RunArguments& arguments,
                     const fs::path& folder) {
  requireModel(experiment);
  ProgressLine line(arguments.quiet);
  RunOptions options;
  options.folder = folder;
  options.store = arguments.store;
  options.command = arguments.command_line;
  runFeatures(experiment, options, makeControl(arguments, line));
  line.clear();
  std::cerr << "Features: " << (folder / "features.h5").string() << "\n";
}

void runCases(const YamlNode& tree, const RunArguments& arguments, const fs::path& folder) {
  showWarningsOnly();
  ProgressLine line(arguments.quiet);
  SweepOptions options;
  options.folder = folder;
  options.store = arguments.store;
  options.memory = chooseMemory(arguments);
  options.most_memory = getMostMemory(arguments);
  options.fail_fast = arguments.fail_fast;
  options.command = arguments.command_line;
  const SweepResult result = runSweep(tree, options, makeControl(arguments, line));
  line.clear();
  std::cout << result.table;
  std::cerr << "Cases: " << result.complete << " of " << result.cases << " complete";
  std::cerr << (result.skipped > 0 ? " (" + std::to_string(result.skipped) + " before)" : "") << ", "
            << result.failures.size() << " failed\nReport: " << (folder / "report.html").string() << "\n";
  if (result.stopped) {
    throw Interrupted("interrupted");
  }
  if (!result.failures.empty()) {
    throw std::runtime_error(fmt::format("{} of {} cases failed; reasons and commands are in {}",
                                         result.failures.size(), result.cases,
                                         (folder / "failed_cases.csv").string()));
  }
  requireGates(result.gates, arguments.fail_on_gates);
}

}  // namespace

std::filesystem::path chooseFolder(const RunArguments& arguments, const ExperimentSpec& experiment) {
  return arguments.folder.empty() ? "results/" + experiment.name.text : arguments.folder;
}

double getMostMemory(const RunArguments& arguments) {
  return std::max(getAvailableMemory(), arguments.memory * kGibibyte);
}

double chooseMemory(const RunArguments& arguments) {
  constexpr double kShare = 0.5;
  return arguments.memory > 0.0 ? arguments.memory * kGibibyte : kShare * getMachineMemory();
}

void run(const RunArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const ExperimentSpec experiment = readExperimentWithSignals(tree);
  requireStatedNoise(experiment);
  const fs::path folder = chooseFolder(arguments, experiment);
  if (arguments.quiet) {
    showWarningsOnly();
  }
  try {
    const bool sweep = readSweep(tree).has_value();
    if (sweep && arguments.features_only) {
      throw ExperimentError(
          "--features-only cannot be combined with a sweep; write the features of each case alone");
    }
    if (arguments.features_only) {
      runFeaturesOnly(experiment, arguments, folder);
    } else {
      sweep ? runCases(tree, arguments, folder) : runSingle(experiment, arguments, folder);
    }
  } catch (const Interrupted& interrupted) {
    throw Interrupted(std::string(interrupted.what()) + "; the same command continues:\n  " +
                      arguments.command_line);
  } catch (const DiskFull& full) {
    throw DiskFull(std::string(full.what()) + "; with more room the same command continues:\n  " +
                   arguments.command_line);
  }
  if (getSignal() != 0) {
    throw Interrupted("interrupted, after everything was done");
  }
}

}  // namespace twinmap::cli
