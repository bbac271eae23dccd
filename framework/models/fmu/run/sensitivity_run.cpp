#include "framework/models/fmu/run/sensitivity_run.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

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

}  // namespace twinmap::fmi
