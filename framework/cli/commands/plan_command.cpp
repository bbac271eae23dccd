
#include <iostream>

#include "framework/base/log/log.hpp"
#include "framework/cli/commands/commands.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/study/sweep/plan.hpp"

namespace twinmap::cli {
namespace {

bool fits(const ExperimentSurvey& survey, const PlanOptions& options, double most_memory) {
  try {
    requireFit(survey, planRun(survey, options), options, most_memory);
    return true;
  } catch (const ExperimentError&) {
    return false;
  }
}

}  // namespace

void plan(const RunArguments& arguments) {
  const YamlNode tree = loadExperimentTree(arguments.experiment.file, arguments.experiment.overrides);
  const PlanOptions options{arguments.threads, chooseMemory(arguments)};
  std::vector<SweepCase> cases = expandCasesWithSignals(tree);
  followNoise(cases);
  if (cases.size() == 1) {
    cases.front().experiment = reduceLongRecord(cases.front().experiment);
  }
  silenceLog();  // of the small runs that are timed
  ExperimentSurvey survey =
      surveyCases(std::move(cases), {chooseFolder(arguments, readExperiment(tree)), arguments.store});
  const double most_memory = getMostMemory(arguments);
  if (fits(survey, options, most_memory)) {
    measureTimes(survey);
  } else {
    survey.times.failure = "not measured, for it does not fit";
  }
  const SweepPlan plan = planRun(survey, options);
  std::cout << describePlan(plan, options) << std::flush;
  requireFit(survey, plan, options, most_memory);
}

}  // namespace twinmap::cli
