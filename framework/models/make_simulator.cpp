#include "framework/models/make_simulator.hpp"

#include "framework/models/external/program_simulator.hpp"
#include "framework/models/fmu/fmu_simulator.hpp"
#include "framework/models/mechanism/simulator/multibody_simulator.hpp"
#include "framework/models/trials_simulator.hpp"
#include "framework/simulation/simulation_failure.hpp"

namespace twinmap {
namespace {

std::unique_ptr<Simulator> make(const ModelSpec& model, const Eigen::VectorXd& times, int modes,
                                ModelCheck check) {
  if (!model.trials.empty()) {
    return std::make_unique<TrialsSimulator>(
        model, times, modes, [&](const ModelSpec& trial, const Eigen::VectorXd& own_times, int own_modes) {
          return make(trial, own_times, own_modes, check);
        });
  }
  if (model.source && model.simulation.portable) {
    throw ExperimentError(
        "simulation.portable: true cannot be held for a model from elsewhere: what an FMU or a program "
        "computes "
        "with is its own");
  }
  if (model.source && model.source->program) {
    return std::make_unique<ProgramSimulator>(model, times, modes);
  }
  if (model.source) {
    return std::make_unique<FmuSimulator>(model, times, modes);
  }
  try {
    return std::make_unique<MultibodySimulator>(model, times, modes, check);
  } catch (const SimulationFailure& failure) {  // numbers at the centre of the bounds
    const std::string place = toString(failure.getWhere());
    throw ExperimentError((place.empty() ? "" : place + ": ") + failure.what());
  }
}

}  // namespace

std::unique_ptr<Simulator> makeSimulator(const ModelSpec& model, const Eigen::VectorXd& times, int modes) {
  return make(model, times, modes, ModelCheck::kBySimbody);
}

std::unique_ptr<Simulator> makeTrustedSimulator(const ModelSpec& model, const Eigen::VectorXd& times,
                                                int modes) {
  return make(model, times, modes, ModelCheck::kTrusted);
}

}  // namespace twinmap
