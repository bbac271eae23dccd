#include "framework/models/fmu/run/runner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/models/fmu/run/model_exchange_problem.hpp"

namespace twinmap::fmi {
namespace {

/// The FMU's equations and, behind its states, dx/dp in its own units, parameter by parameter.
class SensitivityProblem final : public ModelExchangeProblem {
 public:
  SensitivityProblem(SampleRun& run, const SensitivityPlan& plan, Eigen::Ref<Eigen::MatrixXd> derivatives)
      : ModelExchangeProblem(run), plan_(plan), derivatives_(derivatives), count_(plan.states.size()) {
    for (const SensitivityPlan::Output& output : plan.outputs) {
      if (output.state < 0) {
        unknown_outputs_.push_back(output.reference);
      }
    }
    output_derivatives_.resize(unknown_outputs_.size());
  }

  State makeState() const override {
    State x(count_ * (1 + plan_.parameters.size()));
    for (std::size_t j = 0; j < plan_.parameters.size(); ++j) {
      if (plan_.parameters[j].state >= 0) {
        x[count_ * (1 + j) + static_cast<std::size_t>(plan_.parameters[j].state)] =
            plan_.parameters[j].factor;
      }
    }
    return x;
  }

  void calcDerivative(double t, const State& x, State& dxdt) override {
    ModelExchangeProblem::calcDerivative(t, x, dxdt);
    const bool known = std::isfinite(dxdt.front());
    for (std::size_t j = 0; j < plan_.parameters.size(); ++j) {
      double* own = dxdt.data() + count_ * (1 + j);
      if (known) {
        calcAlong(x, j, plan_.derivatives, own);
      } else {
        std::fill(own, own + count_, std::numeric_limits<double>::quiet_NaN());
      }
    }
  }

  void handleEvent(double t, State& x) override {
    ModelExchangeProblem::handleEvent(t, x);
    has_events_ = true;
  }

  void recordOutput(int index, double t, const State& x) override {
    ModelExchangeProblem::recordOutput(index, t, x);
    const Eigen::Index times = run_.setting.times.size();
    for (std::size_t j = 0; j < plan_.parameters.size(); ++j) {
      calcAlong(x, j, unknown_outputs_, output_derivatives_.data());
      std::size_t unknown = 0;
      for (std::size_t i = 0; i < plan_.outputs.size(); ++i) {
        const SensitivityPlan::Output& output = plan_.outputs[i];
        const double value = output.state >= 0 ? x[count_ * (1 + j) + static_cast<std::size_t>(output.state)]
                                               : output_derivatives_[unknown++];
        derivatives_(static_cast<Eigen::Index>(i) * times + index, static_cast<Eigen::Index>(j)) =
            output.factor * value;
      }
    }
  }

  /// What an event does to the derivatives is not known.
  bool isSmooth() const { return !has_events_ && !states_jumped_; }

 private:
  /// Derivatives of the unknowns by parameter j, along its dx/dp.
  void calcAlong(const State& x, std::size_t j, const std::vector<std::uint32_t>& unknowns, double* values) {
    if (unknowns.empty()) {
      return;
    }
    const SensitivityPlan::Parameter& parameter = plan_.parameters[j];
    knowns_ = plan_.states;
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(count_ * (1 + j));
    seed_.assign(begin, begin + static_cast<std::ptrdiff_t>(count_));
    if (parameter.known) {
      knowns_.push_back(*parameter.known);
      seed_.push_back(parameter.factor);
    }
    fmu_.getDirectionalDerivative(unknowns, knowns_, seed_, values);
  }

  const SensitivityPlan& plan_;
  Eigen::Ref<Eigen::MatrixXd> derivatives_;
  std::size_t count_;  ///< states
  std::vector<std::uint32_t> unknown_outputs_, knowns_;
  std::vector<double> output_derivatives_, seed_;
  bool has_events_ = false;
};

/// Derivatives of the response (rows of the response x parameters) along the steps that a simulation of the
/// same sample has taken (`run.path`, explicit): those of its numerical solution, exact up to rounding. False
/// where an event makes them unknown. Throws SimulationFailure where the FMU fails. Cost: beside the
/// simulation's, two calls for directional derivatives an evaluation and parameter at most.
bool runSensitivities(SampleRun& run, const SensitivityPlan& plan, Eigen::Ref<Eigen::MatrixXd> derivatives) {
  run.initialise();
  run.excitation.mute();  // its first phase begins again
  SensitivityProblem problem(run, plan, derivatives);
  const HybridReport report = integrateHybrid(problem, problem.makeState(), collectBoundaries(run),
                                              run.setting.times, run.setting.integration, &run.path.steps);
  if (!report.failure.empty()) {
    throw FmuFailure(report.failure);
  }
  return problem.isSmooth();
}

}  // namespace

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
