#include "framework/models/mechanism/lanes/lane_runner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/lanes/delayed_outputs.hpp"
#include "framework/models/mechanism/lanes/lane_modes.hpp"
#include "framework/models/mechanism/lanes/lane_start.hpp"
#include "framework/models/mechanism/readings.hpp"
#include "framework/models/mechanism/switch_numbers.hpp"
#include "framework/simulation/integration/integration.hpp"
#include "kernels/lanes/integrator.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Parameters = Eigen::Ref<const VectorXd>;

/// Radau IIA takes fewer, longer steps in less time where a state's rate, such as a stiff bristle's, forces
/// more than these. A method of order 5 takes tolerance^(-1/5) as many where accuracy decides.
constexpr double kExplicitSteps = 20000.0, kUsualTolerance = 3e-7;
/// A controller that samples asks for steps that say nothing of stiffness.
constexpr double kStepsOfInstant = 10.0;

int getMaxSteps(const ModelSpec& spec, const LaneModel& model) {
  const int given = spec.simulation.max_steps;
  if (model.getFirstOrderCount() == 0 || model.hasEvents()) {  // not tried again
    return given;
  }
  double instants = 0.0;
  for (const RecordedClock& clock : model.sampling.clocks) {
    instants += spec.simulation.duration / clock.period;
  }
  const double finer = std::max(1.0, kUsualTolerance / spec.simulation.relative_tolerance);
  const double longest = kExplicitSteps * std::pow(finer, 0.2);
  return static_cast<int>(std::min(1e9, std::min<double>(given, longest) + kStepsOfInstant * instants));
}

lanes::Options makeOptions(const ModelSpec& spec, const LaneModel& model) {
  lanes::Options options;
  options.relative_tolerance = spec.simulation.relative_tolerance;
  options.absolute_tolerance = spec.simulation.absolute_tolerance;
  options.max_steps = getMaxSteps(spec, model);
  options.max_wall_time = spec.simulation.max_wall_time;
  const VectorXd widths = calcWidths(collectSampled(spec))(model.directions);
  options.parameter_scales.assign(widths.begin(), widths.end());
  return options;
}

std::string describeEvents(const lanes::Result& result) {
  return result.events == 0 ? "" : fmt::format(", behind {} impacts and changes of friction", result.events);
}

std::string describeOutcome(const lanes::Result& result, const ModelSpec& spec, const LaneModel& model) {
  switch (result.outcome) {
    case lanes::Outcome::kDone:
      return "";
    case lanes::Outcome::kStepLimit:
      return describeStepLimit(getMaxSteps(spec, model), result.time) + describeEvents(result);
    case lanes::Outcome::kWallTime:
      return describeWallTime(spec.simulation.max_wall_time, result.time);
    case lanes::Outcome::kNonFinite:
      return describeAt("state became non-finite", result.time);
    case lanes::Outcome::kStepTooSmall:
      return describeAt("step size became too small", result.time);
    case lanes::Outcome::kEventsStuck:
      return describeAt("impacts, sticking and sliding follow one another without end", result.time);
    case lanes::Outcome::kSingular:
      return model.loops ? describeAt(getSingularReason(model), result.time) : getSingularReason(model);
  }
  return "";
}

}  // namespace

/// A batch on its way through the lanes: prepares one sample after the other, and notes how each ended.
class LaneRunner::Impl : public lanes::SampleStream {
 public:
  Impl(const LaneModel& model, const SampleTask& task, const ModelSpec& spec)
      : model_(model),
        task_(task),
        spec_(spec),
        start_(spec, model, task.box_center, task.layout.times),
        modes_(model) {}

  std::vector<Index> run(NumberChecks& checks, const Eigen::Ref<const MatrixXd>& parameters,
                         Eigen::Ref<MatrixXd> responses, MatrixXd* derivatives, SampleStatus* statuses) {
    checks_ = &checks;
    parameters_ = &parameters;
    responses_ = &responses;
    statuses_ = statuses;
    next_ = 0;
    step_limits_.clear();
    if (derivatives != nullptr) {
      derivatives->setZero(responses.rows(), parameters.size());
      output_derivatives_.resize(getRecordedRows() * model_.countDirections(), parameters.cols());
    }
    derivatives_ = derivatives;
    if (getRecordedRows() > getOutputRows()) {
      recorded_.resize(getRecordedRows(), parameters.cols());
    }
    updIntegrator(static_cast<int>(parameters.cols())).run(*this);
    return std::move(step_limits_);
  }

  bool next(lanes::Sample& sample) override {
    while (next_ < parameters_->cols()) {
      const Index column = next_++;
      const std::string failure = prepare(column, sample);
      if (failure.empty() && getOutputRows() > 0) {
        return true;
      }
      conclude(column, failure);
    }
    return false;
  }

  void finish(const lanes::Sample& sample, const lanes::Result& result) override {
    statuses_[sample.index].machine_dependent = result.outcome == lanes::Outcome::kWallTime;
    if (result.outcome == lanes::Outcome::kStepLimit) {
      step_limits_.push_back(sample.index);
    }
    conclude(sample.index, describeOutcome(result, spec_, model_));
  }

 private:
  /// With as many lanes as suit so many samples.
  lanes::Integrator& updIntegrator(int samples) {
    const lanes::StepEngine& suitable = lanes::chooseEngine(samples, model_.problem);
    if (engine_ != &suitable) {
      const VectorXd& times = task_.layout.times;
      integrator_.emplace(model_.problem, std::vector<double>(times.begin(), times.end()),
                          makeOptions(spec_, model_), suitable);
      engine_ = &suitable;
    }
    return *integrator_;
  }

  Index getOutputRows() const { return task_.layout.getOutputCount() * task_.layout.times.size(); }
  /// With what is subtracted.
  Index getRecordedRows() const { return model_.problem.output_count * task_.layout.times.size(); }

  /// The reason why the sample cannot be simulated, or "".
  std::string prepare(Index column, lanes::Sample& sample) {
    statuses_[column] = {};
    try {
      const VectorXd point = parameters_->col(column);
      checks_->check(point);
      fillModes(column, point);
      start_.fill(point, sample);
      ModelContext& context = checks_->updContext();
      requireWithinStops(context.model.system, context.names, context.numbers,
                         Eigen::Map<const VectorXd>(sample.initial.data(), model_.coordinate_count));
    } catch (const SimulationFailure& failure) {
      return failure.what();
    }
    if (model_.is_memoryless) {
      sample.initial.clear();
    }
    sample.index = static_cast<int>(column);
    sample.outputs = recorded_.size() > 0 ? recorded_.col(column).data() : responses_->col(column).data();
    sample.derivatives = derivatives_ == nullptr ? nullptr : output_derivatives_.col(column).data();
    return "";
  }

  VectorXd calcModes(const VectorXd& point) {
    return modes_.calc(point, start_.solveEquilibrium(point), task_.layout.modes);
  }

  /// With derivatives by central differences: they take no integration, and eigenvalues are exact to
  /// rounding.
  void fillModes(Index column, const VectorXd& point) {
    const int rows = 2 * task_.layout.modes;
    if (rows == 0) {
      return;
    }
    responses_->col(column).tail(rows) = calcModes(point);
    if (derivatives_ == nullptr) {
      return;
    }
    constexpr double kStep = 1e-5;  // of the bounds' width: rounding and truncation are then both about 1e-10
    const VectorXd widths = calcWidths(collectSampled(spec_));
    for (const int k : model_.directions) {
      VectorXd above = point, below = point;
      above[k] += kStep * widths[k];
      below[k] -= kStep * widths[k];
      derivatives_->col(column * point.size() + k).tail(rows) =
          (calcModes(above) - calcModes(below)) / (above[k] - below[k]);
    }
  }

  void conclude(Index column, const std::string& failure) {
    SampleStatus& status = statuses_[column];
    status.reason = failure;
    if (failure.empty()) {
      takeReadings(column);
    }
    if (failure.empty() && !responses_->col(column).allFinite()) {
      status.reason = "an output became non-finite";
    }
    if (status.reason.empty() && derivatives_ != nullptr) {
      takeDerivatives(column, status);
    }
    status.ok = status.reason.empty();
    if (!status.ok) {
      responses_->col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }

  void takeDerivatives(Index column, SampleStatus& status) {
    const Index p = parameters_->rows(), rows = getOutputRows(), asked = model_.countDirections();
    const MatrixXd recorded = output_derivatives_.col(column).reshaped(getRecordedRows(), asked);
    auto derivatives = derivatives_->middleCols(column * p, p);
    auto along = derivatives(Eigen::all, model_.directions);
    along.topRows(rows) = recorded.topRows(rows);
    subtractBefore(model_.sampling.subtracted, task_.layout.times.size(), recorded, along);
    for (Index row = 0; row < rows; ++row) {
      const Bounds* range = findRange(spec_, task_.layout, row);
      if (range != nullptr && isClipped(*range, (*responses_)(row, column))) {
        derivatives.row(row).setZero();
      }
    }
    if (!derivatives_->middleCols(column * p, p).allFinite()) {
      status.reason = "a derivative of an output became non-finite";
    }
  }

  /// What sensors show of the recorded outputs, but for rounding, which counts as noise.
  void takeReadings(Index column) {
    auto response = responses_->col(column);
    if (recorded_.size() > 0) {
      response.head(getOutputRows()) = recorded_.col(column).head(getOutputRows());
      subtractBefore(model_.sampling.subtracted, task_.layout.times.size(), recorded_.col(column), response);
    }
    clipReadings(spec_, task_.layout, response);
  }

  const LaneModel& model_;
  const SampleTask task_;
  const ModelSpec& spec_;
  LaneStart start_;
  LaneModes modes_;
  const lanes::StepEngine* engine_ = nullptr;
  std::optional<lanes::Integrator> integrator_;
  NumberChecks* checks_ = nullptr;
  const Eigen::Ref<const MatrixXd>* parameters_ = nullptr;
  Eigen::Ref<MatrixXd>* responses_ = nullptr;
  MatrixXd* derivatives_ = nullptr;
  MatrixXd recorded_;            ///< outputs of a sample; empty where they are the response
  MatrixXd output_derivatives_;  ///< of a sample all directions, one after the other
  SampleStatus* statuses_ = nullptr;
  Index next_ = 0;
  std::vector<Index> step_limits_;
};

LaneRunner::LaneRunner(const LaneModel& model, const SampleTask& task, const ModelSpec& spec)
    : impl_(std::make_unique<Impl>(model, task, spec)) {}
LaneRunner::~LaneRunner() = default;

std::vector<Index> LaneRunner::run(NumberChecks& checks, const Eigen::Ref<const MatrixXd>& parameters,
                                   Eigen::Ref<MatrixXd> responses, MatrixXd* derivatives,
                                   SampleStatus* statuses) {
  return impl_->run(checks, parameters, responses, derivatives, statuses);
}

}  // namespace twinmap
