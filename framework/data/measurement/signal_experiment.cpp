#include "framework/data/measurement/signal_experiment.hpp"

#include "framework/data/measurement/measured_signals.hpp"
#include "framework/experiment/experiment_file.hpp"

namespace twinmap {

ExperimentSpec readExperimentWithSignals(const YamlNode& root) {
  ExperimentSpec experiment = readExperiment(root);
  loadMeasuredSignals(experiment);
  return experiment;
}

std::vector<SweepCase> expandCasesWithSignals(const YamlNode& root) {
  std::vector<SweepCase> cases = expandCases(root);
  for (SweepCase& one : cases) {
    loadMeasuredSignals(one.experiment);
  }
  return cases;
}

}  // namespace twinmap
