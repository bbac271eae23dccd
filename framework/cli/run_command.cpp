#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/experiment.hpp"
#include "framework/report/tables.hpp"
#include "framework/spec/experiment_file.hpp"

namespace twinmap {

void run(const RunArguments& arguments) {
  const ExperimentSpec experiment = loadExperiment(arguments.experiment.file, arguments.experiment.overrides);
  RunOptions options;
  options.folder = arguments.folder.empty() ? "results/" + experiment.name.text : arguments.folder;
  options.store = arguments.store;
  options.threads = arguments.threads;
  options.command = arguments.command_line;
  const RunSummary summary = runExperiment(experiment, options);
  std::cout << makeMarkdownTable(summary);
  for (const std::string& warning : summary.warnings) {
    std::cerr << "twinmap: warning: " << warning << "\n";
  }
  if (!summary.failures.empty()) {
    std::cerr << "twinmap: warning: " << summary.failures.size() << " samples failed; see "
              << (options.folder / "failures.csv").string() << "\n";
  }
  std::cerr << "Report: " << (options.folder / "report.html").string() << "\n";
  requireGates(summary.gates, arguments.fail_on_gates);
}

}  // namespace twinmap
