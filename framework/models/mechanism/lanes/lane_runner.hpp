#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/lanes/number_checks.hpp"
#include "framework/models/mechanism/sample_task.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// Simulates parameter sets in lanes. Not thread safe; one for each thread.
class LaneRunner {
 public:
  /// `model` and `spec` must outlive the runner.
  LaneRunner(const LaneModel& model, const SampleTask& task, const ModelSpec& spec);
  ~LaneRunner();

  /// As Simulator::simulate. `derivatives`: null, or for each column of `parameters` one column a parameter;
  /// the model must have been compiled with derivatives then. Returns the columns that reached the step
  /// limit.
  std::vector<Eigen::Index> run(NumberChecks& checks, const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd* derivatives,
                                SampleStatus* statuses);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace twinmap
