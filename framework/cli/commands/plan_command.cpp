
#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/study/sweep/plan.hpp"

namespace twinmap::cli {

void plan(const RunArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const PlanOptions options{arguments.threads, chooseMemory(arguments)};
  std::vector<SweepCase> cases = expandCasesWithSignals(tree);
  followNoise(cases);
  silenceLog();  // of the small runs that are timed
  const ExperimentSurvey survey =
      surveyCases(std::move(cases), {chooseFolder(arguments, readExperiment(tree)), arguments.store});
  const SweepPlan plan = planRun(survey, options);
  std::cout << describePlan(plan, options) << std::flush;
  requireFit(survey, plan, options, getMostMemory(arguments));
}

}  // namespace twinmap::cli
