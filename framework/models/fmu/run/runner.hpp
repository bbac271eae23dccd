#pragma once

#include <memory>

#include "framework/models/fmu/run/run_setting.hpp"
#include "framework/models/fmu/run/sample_run.hpp"
#include "framework/models/fmu/run/sensitivity_plan.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap::fmi {

/// Simulates samples by one FMU in this process, one after another: the instance is reset between them, or
/// made anew where it cannot be. Not thread safe.
class Runner {
 public:
  /// Loads the library and makes an instance. `source` and its description outlive the runner. `signals`: of
  /// the excitation. Throws ExperimentError or FmuFailure where the FMU cannot be used.
  Runner(const InstanceSource& source, RunSetting setting, int signals);

  /// `parameters`: the experiment's point; `excitation`: updated for it. The response is NaN where the status
  /// is not ok. `path`: steps of Model Exchange to take, or an empty one that gets those that were taken
  /// unless there were state events; a sample that cannot take the steps chooses its own. What reaches the
  /// step limit is integrated once more by an implicit method.
  SampleStatus run(const double* parameters, Excitation& excitation, Eigen::Ref<Eigen::VectorXd> response,
                   IntegrationPath& path);

  /// The derivatives of the response (rows x parameters of the plan) at a sample that run() has simulated
  /// with the steps of `path`. False where they cannot be had from the FMU there.
  bool runDerivatives(const double* parameters, Excitation& excitation, IntegrationPath& path,
                      const SensitivityPlan& plan, Eigen::Ref<Eigen::MatrixXd> derivatives);

  /// False once the FMU has ended with Fatal, or can neither be reset nor made anew: this process is to end.
  bool isUsable() const { return usable_; }

 private:
  /// A sample on its way.
  struct Task {
    const double* parameters;
    Excitation& excitation;
    Eigen::Ref<Eigen::VectorXd> response;
    IntegrationPath& path;
    const SensitivityPlan* plan = nullptr;  ///< null: no derivatives
    Eigen::Ref<Eigen::MatrixXd>* derivatives = nullptr;
    bool has_derivatives = false;
  };
  void simulate(Task& task);
  void simulateOnce(Task& task, double largest_step);
  void renew();
  double chooseStep() const;

  InstanceSource source_;
  RunSetting setting_;
  InstanceFactory factory_;
  BoundGroup parameters_, outputs_;
  DrivenInputs inputs_;
  std::unique_ptr<Instance> instance_;
  bool fresh_ = true, usable_ = true;
};

}  // namespace twinmap::fmi
