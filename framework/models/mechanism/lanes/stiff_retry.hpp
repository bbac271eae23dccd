#pragma once

#include <optional>

#include "framework/models/mechanism/lanes/lane_modes.hpp"
#include "framework/models/mechanism/sample_task.hpp"
#include "framework/simulation/integration/hybrid_integration.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What reached the step limit of an explicit method may be stiff: this tries it once more by Radau IIA
/// (radau_stepper.hpp) on the recorded equations, with their exact Jacobian. Not thread safe.
class StiffRetry {
 public:
  /// All must outlive this.
  StiffRetry(const ModelSpec& spec, const LaneModel& model, const StiffPrograms& programs,
             const SampleTask& task);

  /// One column; `status`: of the first try, becomes that of the second.
  void simulate(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::Ref<Eigen::VectorXd> response,
                SampleStatus& status);

  /// The same with the derivatives (rows of the response x parameters), by differences of solutions that
  /// share their steps (makeNeighbours), where the steps' own errors cancel. Fails if one of the 2 p + 1
  /// simulations does.
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                               Eigen::Ref<Eigen::VectorXd> response, Eigen::Ref<Eigen::MatrixXd> derivatives,
                               SampleStatus& status);

 private:
  /// With the steps of `sequence` if there are any, else it keeps there those it took.
  SampleStatus run(const Eigen::Ref<const Eigen::VectorXd>& parameters, Eigen::Ref<Eigen::VectorXd> response,
                   StepSequence& sequence);

  const ModelSpec& spec_;
  const LaneModel& model_;
  const SampleTask task_;
  LaneStart start_;
  LaneModes modes_;
  SingleProgram derivative_, output_, jacobian_;
  std::optional<SingleProgram> jump_;
};

}  // namespace twinmap
