#include "framework/models/fmu/run/runner.hpp"

#include <algorithm>
#include <limits>

#include "framework/models/fmu/run/sensitivity_run.hpp"

namespace twinmap::fmi {

Runner::Runner(const InstanceSource& source, RunSetting setting, int signals)
    : source_(source),
      setting_(std::move(setting)),
      factory_(source),
      parameters_(setting_.parameters),
      outputs_(setting_.outputs),
      inputs_(setting_.inputs, signals),
      instance_(factory_.make()) {}

SampleStatus Runner::run(const double* parameters, Excitation& excitation,
                         Eigen::Ref<Eigen::VectorXd> response, IntegrationPath& path) {
  Task task{parameters, excitation, response, path};
  const bool given = !path.steps.empty();
  SampleStatus status;
  try {
    simulate(task);
    status.stiff_retry = path.method == HybridMethod::kImplicit;
  } catch (const WallTimeReached& failure) {
    status = {false, failure.what(), true};
  } catch (const FmuFailure& failure) {
    status = {false, failure.what()};
    usable_ = usable_ && !failure.isFatal();
  } catch (const SimulationFailure& failure) {
    status = {false, failure.what()};
  }
  fresh_ = false;
  if (!status.ok && usable_ && given) {
    IntegrationPath own;
    return run(parameters, excitation, response, own);
  }
  if (!status.ok) {
    response.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return status;
}

bool Runner::runDerivatives(const double* parameters, Excitation& excitation, IntegrationPath& path,
                            const SensitivityPlan& plan, Eigen::Ref<Eigen::MatrixXd> derivatives) {
  Eigen::VectorXd response(derivatives.rows());
  Task task{parameters, excitation, response, path, &plan, &derivatives};
  try {
    simulate(task);
  } catch (const FmuFailure& failure) {
    usable_ = usable_ && !failure.isFatal();
    task.has_derivatives = false;
  } catch (const SimulationFailure&) {
    task.has_derivatives = false;
  }
  fresh_ = false;
  return task.has_derivatives && derivatives.allFinite();
}

double Runner::chooseStep() const {
  constexpr double kStepsByDefault = 1000.0;  // per duration, where neither the user nor the FMU says one
  const Capabilities& can = source_.description.getCapabilities(setting_.kind);
  const DefaultExperiment& defaults = source_.description.default_experiment;
  return setting_.step.value_or(
      defaults.step.value_or(can.internal_step.value_or(setting_.duration / kStepsByDefault)));
}

void Runner::simulate(Task& task) {
  constexpr int kMaxHalvings = 10;  // to a thousandth of the step
  double step = chooseStep();
  for (int i = 0;; ++i, step *= 0.5) {
    try {
      return simulateOnce(task, step);
    } catch (const StepDiscarded&) {  // a step cannot be taken back; a simulation can begin again
      if (i == kMaxHalvings) {
        throw;
      }
      fresh_ = false;
    } catch (const StepLimitReached&) {
      task.path = {{}, HybridMethod::kImplicit};
      fresh_ = false;
    }
  }
}

void Runner::simulateOnce(Task& task, double largest_step) {
  if (!fresh_) {
    renew();
  }
  if (!parameters_.isEmpty()) {
    parameters_.set(*instance_, task.parameters);
  }
  SampleRun run{*instance_,      setting_, source_.description.getCapabilities(setting_.kind),
                task.excitation, inputs_,  outputs_,
                task.response,   task.path};
  if (task.plan != nullptr) {
    task.has_derivatives = runSensitivities(run, *task.plan, *task.derivatives);
  } else {
    setting_.kind == Kind::kCoSimulation ? runCoSimulation(run, largest_step) : runModelExchange(run);
  }
  instance_->terminate();
}

void Runner::renew() {
  if (instance_ != nullptr && instance_->reset()) {
    return;
  }
  instance_ = nullptr;
  const Capabilities& can = source_.description.getCapabilities(setting_.kind);
  if (can.can_be_instantiated_only_once) {
    throw FmuFailure("the FMU can neither be reset nor made twice in one process", true);
  }
  instance_ = factory_.make();
}

}  // namespace twinmap::fmi
