#include "framework/models/mechanism/lanes/compare_with_simbody.hpp"

#include <fmt/core.h>

#include <optional>
#include <random>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/lanes/lane_start.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

constexpr int kPoints = 5, kStates = 4;
constexpr double kTolerance =
    1e-10;  // of the largest; rounding leaves less, unless the mass matrix is near singular

/// Uniform from `lower` to `upper`, the same on every machine.
class Draws {
 public:
  VectorXd draw(const VectorXd& lower, const VectorXd& upper) {
    return lower.binaryExpr(upper, [this](double a, double b) { return draw(a, b); });
  }
  double draw(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(generator_()) / 4294967296.0;
  }

 private:
  std::mt19937 generator_{1};
};

/// "" or what differs. `size`: of the terms that may cancel in the values.
std::string compare(const char* what, const std::vector<std::string>& names, const VectorXd& values,
                    const VectorXd& expected, double size) {
  constexpr double kCancellation = 1e-3;  // leaves 1e-13 of the terms, above rounding
  const double largest = kCancellation * size + (expected.size() > 0 ? expected.cwiseAbs().maxCoeff() : 0.0);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const bool both_infinite = !std::isfinite(values[i]) && !std::isfinite(expected[i]);
    if (!both_infinite && !(std::abs(values[i] - expected[i]) <= kTolerance * largest)) {
      return fmt::format("{} '{}' is {:.12g}, by Simbody {:.12g}", what, names[i], values[i], expected[i]);
    }
  }
  return "";
}

/// One parameter set, seen by both.
class Comparison {
 public:
  Comparison(ModelContext& context, SimbodyModel& simbody, const LaneModel& model, const VectorXd& point)
      : context_(context),
        simbody_(simbody),
        model_(model),
        derivative_(model.problem.derivative),
        output_(model.problem.output),
        start_(model.start),
        point_(point) {
    simbody.setParameters(point);
    if (model.loops) {
      assembly_.emplace(*model.loops);
    }
  }

  std::string compareAt(InitialState at, double time) {
    if (assembly_ && !assemble(at)) {
      return "";
    }
    const VectorXd events =
        start_.calc({point_}).segment(model_.counts.states, model_.excitation.events.size());
    const std::vector<double> event_times(events.begin(), events.end());
    const double begin = findPhase(event_times, time);
    const SimbodyMotion expected = simbody_.calcMotion(at, time, begin);
    const Eigen::Index n = at.coordinates.size(), m = at.states.size();
    ProgramInputs inputs{point_, VectorXd(2 * n + m), VectorXd(model_.excitation.input_count), time};
    inputs.states << at.coordinates, expected.speeds, at.states;
    fillPhaseInputs(model_.excitation, event_times, begin, inputs.phase_inputs.data());
    const double size = expected.speeds.squaredNorm();
    VectorXd outputs = output_.calc(inputs).head(expected.outputs.size());
    takeIndeterminate(expected.outputs, outputs);
    const VectorXd derivatives = derivative_.calc(inputs);
    std::string difference = compare("acceleration of", context_.names.getCoordinateNames(),
                                     derivatives.segment(n, n), expected.accelerations, size);
    if (difference.empty()) {
      difference = compare("rate of", context_.names.getStateNames(), derivatives.segment(2 * n, m),
                           expected.state_rates, size);
    }
    return !difference.empty() ? difference
                               : compare("output", getOutputNames(), outputs, expected.outputs, size);
  }

 private:
  /// Where conditions of loops are redundant, how they share their forces is not determined.
  void takeIndeterminate(const VectorXd& expected, VectorXd& outputs) const {
    const bool redundant = model_.loops && model_.loops->plan.rows.size() < model_.loops->labels.size();
    for (std::size_t i = 0; redundant && i < context_.model.outputs.size(); ++i) {
      const OutputSpec& output = context_.model.outputs[i];
      if (output.reaction ||
          (output.force_of && context_.names.findForce(*output.force_of).constraint >= 0)) {
        outputs[static_cast<Eigen::Index>(i)] = expected[static_cast<Eigen::Index>(i)];
      }
    }
  }

  /// Whether the loops can be closed from there.
  bool assemble(InitialState& at) {
    try {
      at.coordinates = assembly_->close(point_, at.coordinates);
      at.speeds = assembly_->calcRates(point_, at.coordinates, at.speeds);
    } catch (const SimulationFailure&) {
      return false;
    }
    return true;
  }

  double findPhase(const std::vector<double>& events, double time) {
    double begin = 0.0;
    for (const Boundary& boundary :
         calcBoundaries(model_.excitation, events, 0.0, context_.model.simulation.duration)) {
      begin = boundary.time <= time ? boundary.time : begin;
    }
    return begin;
  }

  std::vector<std::string> getOutputNames() const {
    std::vector<std::string> names;
    for (const OutputSpec& output : context_.model.outputs) {
      names.push_back(output.name.text);
    }
    return names;
  }

  ModelContext& context_;
  SimbodyModel& simbody_;
  const LaneModel& model_;
  SingleProgram derivative_, output_, start_;
  VectorXd point_;
  std::optional<Assembly> assembly_;  ///< with loops
};

std::string compareAtPoint(ModelContext& context, SimbodyModel& simbody, const LaneModel& model,
                           const VectorXd& point, Draws& draws) {
  context.numbers.update(point);
  Comparison comparison(context, simbody, model, point);
  const InitialState initial = calcInitialValues(context);
  const VectorXd& start = initial.coordinates;
  const VectorXd half = VectorXd::Constant(start.size(), 0.5), two = 4.0 * half;  // m or rad; and a second
  const VectorXd around = VectorXd::Constant(initial.states.size(), 0.5);
  for (int i = 0; i < kStates; ++i) {
    const VectorXd coordinates = draws.draw(start - half, start + half), speeds = draws.draw(-two, two);
    const InitialState at{coordinates, speeds, draws.draw(initial.states - around, initial.states + around)};
    const std::string difference =
        comparison.compareAt(at, draws.draw(0.0, std::max(context.model.simulation.duration, 1e-3)));
    if (!difference.empty()) {
      return difference;
    }
  }
  return "";
}

}  // namespace

std::string compareWithSimbody(ModelContext& context, SimbodyModel& simbody, const LaneModel& model) {
  const std::vector<ParameterSpec> sampled = collectSampled(context.model);
  const VectorXd lower = calcLowerBounds(sampled), upper = lower + calcWidths(sampled);
  Draws draws;
  for (int i = 0; i < kPoints; ++i) {
    try {
      const std::string difference = compareAtPoint(context, simbody, model, draws.draw(lower, upper), draws);
      if (!difference.empty()) {
        return difference;
      }
    } catch (const SimulationFailure&) {
      continue;  // no such system can be simulated, by neither
    }
  }
  return "";
}

}  // namespace twinmap
