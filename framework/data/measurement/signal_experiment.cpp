#include "framework/data/measurement/signal_experiment.hpp"

#include "framework/data/measurement/measured_signals.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {

ExperimentSpec readExperimentWithSignals(const YamlNode& root) {
  ExperimentSpec experiment = readExperiment(root);
  changeTrials(experiment, loadMeasuredSignals);
  return experiment;
}

std::vector<SweepCase> expandCasesWithSignals(const YamlNode& root) {
  std::vector<SweepCase> cases = expandCases(root);
  for (SweepCase& one : cases) {
    changeTrials(one.experiment, loadMeasuredSignals);
  }
  return cases;
}

}  // namespace twinmap
