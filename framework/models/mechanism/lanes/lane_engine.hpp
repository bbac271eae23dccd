#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/models/mechanism/lanes/lane_programs.hpp"
#include "framework/models/mechanism/lanes/lane_runner.hpp"
#include "framework/models/mechanism/lanes/stiff_retry.hpp"

namespace twinmap {

/// Simulates parameter sets in lanes; what reaches the step limit there is tried a second time. Not thread
/// safe; one for each thread.
class LaneEngine {
 public:
  /// All but `task` must outlive the engine. Throws as NumberChecks does.
  LaneEngine(LanePrograms& programs, ModelContext& context, const SampleTask& task)
      : programs_(programs), context_(context), checks_(context), task_(task) {}

  /// As Simulator::simulate.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses);

  /// As Simulator::simulateWithDerivatives.
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses);

 private:
  std::vector<Eigen::Index> keepRetried(std::vector<Eigen::Index> columns) const;
  StiffRetry& updStiffRetry();

  LanePrograms& programs_;
  ModelContext& context_;
  NumberChecks checks_;
  const SampleTask task_;
  std::optional<LaneRunner> runner_, derivative_runner_;  ///< made when first used
  std::optional<StiffRetry> stiff_retry_;                 ///< likewise
};

}  // namespace twinmap
