#pragma once

#include <Eigen/Core>

#include "framework/models/mechanism/sample_task.hpp"
#include "framework/models/mechanism/simbody/loaded_system.hpp"
#include "framework/simulation/integration/integration.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates parameter sets by Simbody, one after the other; builds the system anew for each. Not thread
/// safe; one for each thread.
class SimbodyEngine {
 public:
  /// `context` must outlive the engine.
  SimbodyEngine(SimbodyContext& context, const SampleTask& task) : context_(context), task_(task) {}

  /// As SimbodyModel::simulate.
  SampleStatus simulate(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                        Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence);

 private:
  std::string run(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::Ref<Eigen::VectorXd> response,
                  StepSequence& sequence);
  void fillModes(LoadedSystem& system, Eigen::Ref<Eigen::VectorXd> response);

  SimbodyContext& context_;
  const SampleTask task_;
};

}  // namespace twinmap
