
#include <iostream>

#include "framework/cli/commands.hpp"
#include "framework/measurement/signal_experiment.hpp"
#include "framework/monitoring/log.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/sweep/plan.hpp"

namespace twinmap::cli {

void plan(const RunArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const PlanOptions options{arguments.threads, chooseMemory(arguments)};
  silenceLog();  // of the small runs that are timed
  const ExperimentSurvey survey = surveyCases(
      expandCasesWithSignals(tree), {chooseFolder(arguments, readExperiment(tree)), arguments.store});
  std::cout << describePlan(planRun(survey, options), options);
}

}  // namespace twinmap::cli
