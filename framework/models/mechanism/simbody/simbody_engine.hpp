#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/simbody/loaded_system.hpp"
#include "framework/models/mechanism/simbody/sample_task.hpp"
#include "framework/simulation/integration/integration.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates parameter sets by Simbody, one after the other; builds the system anew for each. Not thread
/// safe; one for each thread.
class SimbodyEngine {
 public:
  /// `context` must outlive the engine.
  SimbodyEngine(ModelContext& context, const SampleTask& task) : context_(context), task_(task) {}

  /// Simulates one parameter set as `simulation`, which may differ from the model's, says. With dopri5, takes
  /// the steps of `sequence` if there are any, else keeps there those it took.
  SampleStatus simulate(const SimulationSpec& simulation, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                        Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence);

 private:
  std::string run(const SimulationSpec& simulation, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                  Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence);
  void fillModes(LoadedSystem& system, Eigen::Ref<Eigen::VectorXd> response);

  ModelContext& context_;
  const SampleTask task_;
};

}  // namespace twinmap
