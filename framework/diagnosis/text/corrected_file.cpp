#include "framework/diagnosis/text/corrected_file.hpp"

#include "framework/data/measurement/measured_signals.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {
namespace {

void freeTolerances(SimulationSpec& simulation) {
  const SimulationSpec defaults;
  if (simulation.relative_tolerance.where.line == 0) {
    simulation.relative_tolerance = defaults.relative_tolerance;
  }
  if (simulation.absolute_tolerance.where.line == 0) {
    simulation.absolute_tolerance = defaults.absolute_tolerance;
  }
}

}  // namespace

std::string writeCorrected(ExperimentSpec experiment) {
  requireSharedSystem(experiment);
  changeTrials(experiment, [](ExperimentSpec& one) {
    freeTolerances(one.model.simulation);
    dropMeasuredSignals(one);
  });
  return writeExperiment(experiment);
}

}  // namespace twinmap
