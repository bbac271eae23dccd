#include "framework/models/mechanism/lanes/stiff_retry.hpp"

#include <algorithm>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/lanes/delayed_outputs.hpp"
#include "framework/models/mechanism/readings.hpp"
#include "framework/simulation/stencil.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The recorded equations of one sample as a problem of the integrators; nothing happens between its phases,
/// and where they begin the states may jump.
class RecordedProblem final : public HybridProblem {
 public:
  /// `recorded`: one column an output, one row a time.
  RecordedProblem(const lanes::Sample& sample, const DelayedOutputs& outputs, Eigen::Ref<MatrixXd> recorded,
                  const char* singular, SingleProgram& derivative, SingleProgram& output,
                  SingleProgram& jacobian, SingleProgram* jump)
      : sample_(sample),
        outputs_(outputs),
        recorded_(recorded),
        singular_(singular),
        derivative_(derivative),
        output_(output),
        jacobian_(jacobian),
        jump_(jump) {}

  std::vector<double> getBoundaries() const {
    std::vector<double> boundaries;
    for (const lanes::Phase& phase : sample_.phases) {
      boundaries.push_back(phase.begin);
    }
    boundaries.push_back(sample_.end);
    return boundaries;
  }

  void enterPhase(double begin, State& x) override {
    const lanes::Phase& phase =
        *std::lower_bound(sample_.phases.begin(), sample_.phases.end(), begin,
                          [](const lanes::Phase& one, double time) { return one.begin < time; });
    for (SingleProgram* program : {&derivative_, &output_, &jacobian_}) {
      program->enterPhase(sample_.parameters, phase.inputs);
    }
    if (phase.jumps) {
      jump_->enterPhase(sample_.parameters, phase.inputs);
      jump_->calcAt(begin, x);
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = jump_->getOutput(static_cast<int>(i));
      }
    }
  }

  void calcDerivative(double t, const State& x, State& dxdt) override {
    derivative_.calcAt(t, x);
    const int n = static_cast<int>(x.size());
    for (int i = 0; i < n; ++i) {
      dxdt[i] = derivative_.getOutput(i);
    }
    for (int i = n; i < derivative_.getOutputCount(); ++i) {
      if (!(derivative_.getOutput(i) > 0.0)) {  // a pivot
        throw SimulationFailure(singular_);
      }
    }
  }

  bool calcJacobian(double t, const State& x, MatrixXd& jacobian) override {
    jacobian_.calcAt(t, x);
    for (Index i = 0; i < jacobian.size(); ++i) {
      jacobian.data()[i] = jacobian_.getOutput(static_cast<int>(i));
    }
    return true;
  }

  void recordOutput(int index, double t, const State& x) override {
    output_.calcAt(t, x);
    outputs_.keep(index, output_, recorded_);
  }

  std::size_t getIndicatorCount() const override { return 0; }
  void calcIndicators(double, const State&, double*) override {}
  bool completeStep(double, const State&) override { return false; }
  void handleEvent(double, State&) override {}
  double getNextEventTime() const override { return std::numeric_limits<double>::infinity(); }
  bool isOver() const override { return false; }

 private:
  const lanes::Sample& sample_;
  const DelayedOutputs& outputs_;
  Eigen::Ref<MatrixXd> recorded_;
  const char* singular_;
  SingleProgram &derivative_, &output_, &jacobian_;
  SingleProgram* jump_;  ///< null where nothing jumps
};

/// A step of Radau IIA costs some ten explicit ones. What needs so many of them is not stiff, but jumps: its
/// step limit would take minutes to reach.
int limitImplicitSteps(int explicit_steps) {
  constexpr int kCost = 10, kEnough = 20000;
  return std::min(explicit_steps, std::max(explicit_steps / kCost, kEnough));
}

SampleStatus makeSecondStatus(const SampleStatus& first, SampleStatus second) {
  second.stiff_retry = true;
  if (!second.ok) {
    second.reason = first.reason + "; by Radau IIA: " + second.reason;
  }
  return second;
}

}  // namespace

StiffRetry::StiffRetry(const ModelSpec& spec, const LaneModel& model, const StiffPrograms& programs,
                       const SampleTask& task)
    : spec_(spec),
      model_(model),
      task_(task),
      start_(spec, model, task.box_center, task.layout.times),
      modes_(model),
      derivative_(programs.derivative),
      output_(model.problem.output),
      jacobian_(programs.jacobian) {
  if (!model.problem.jump.outputs.empty()) {
    jump_.emplace(model.problem.jump);
  }
}

void StiffRetry::simulate(const Eigen::Ref<const VectorXd>& parameters, Eigen::Ref<VectorXd> response,
                          SampleStatus& status) {
  StepSequence own_steps;
  status = makeSecondStatus(status, run(parameters, response, own_steps));
}

void StiffRetry::simulateWithDerivatives(const Eigen::Ref<const VectorXd>& parameters,
                                         Eigen::Ref<VectorXd> response, Eigen::Ref<MatrixXd> derivatives,
                                         SampleStatus& status) {
  const std::vector<ParameterSpec> sampled = collectSampled(spec_);
  const MatrixXd points = makeNeighbours(sampled, parameters);
  MatrixXd responses(response.size(), points.cols());
  StepSequence steps_of_center;
  SampleStatus second;
  for (Index i = 0; i < points.cols() && second.ok; ++i) {
    second = run(points.col(i), responses.col(i), steps_of_center);
  }
  if (second.ok) {
    response = responses.col(0);
    derivatives =
        calcDifferences(responses, sampled, parameters) * calcWidths(sampled).asDiagonal().inverse();
  } else {
    response.setConstant(kNaN);
  }
  status = makeSecondStatus(status, std::move(second));
}

SampleStatus StiffRetry::run(const Eigen::Ref<const VectorXd>& parameters, Eigen::Ref<VectorXd> response,
                             StepSequence& sequence) {
  const SimulationSpec& simulation = spec_.simulation;
  const IntegrationOptions options{simulation.relative_tolerance, simulation.absolute_tolerance,
                                   limitImplicitSteps(simulation.max_steps), simulation.max_wall_time};
  SampleStatus status;
  try {
    if (task_.layout.modes > 0) {
      response.tail(2 * task_.layout.modes) =
          modes_.calc(parameters, start_.solveEquilibrium(parameters), task_.layout.modes);
    }
    lanes::Sample sample;
    start_.fill(parameters, sample);
    const VectorXd& times = task_.layout.times;
    const DelayedOutputs outputs(model_.problem, sample, times);
    MatrixXd recorded(times.size(), model_.problem.output_count);
    RecordedProblem problem(sample, outputs, recorded, getSingularReason(model_), derivative_, output_,
                            jacobian_, jump_ ? &*jump_ : nullptr);
    HybridReport report =
        integrateHybrid(problem, sample.initial, problem.getBoundaries(), outputs.getTimes(), options,
                        sequence.empty() ? nullptr : &sequence, HybridMethod::kImplicit);
    const VectorXd rows = recorded.reshaped();
    response.head(times.size() * task_.layout.getOutputCount()) =
        rows.head(times.size() * task_.layout.getOutputCount());
    subtractBefore(model_.sampling.subtracted, times.size(), rows, response);
    clipReadings(spec_, task_.layout, response);
    status.reason =
        report.failure.empty() && !response.allFinite() ? "an output became non-finite" : report.failure;
    if (status.reason.empty() && sequence.empty()) {
      sequence = std::move(report.sequence);
    }
  } catch (const WallTimeReached& failure) {
    status.reason = failure.what();
    status.machine_dependent = true;
  } catch (const SimulationFailure& failure) {
    status.reason = failure.what();
  }
  status.ok = status.reason.empty();
  if (!status.ok) {
    response.setConstant(kNaN);
  }
  return status;
}

}  // namespace twinmap
