#include "framework/models/mechanism/simbody/compare_with_simbody.hpp"

#include <fmt/core.h>

#include <random>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/initial_state.hpp"
#include "framework/models/mechanism/lanes/lane_start.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"

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
  Comparison(ModelContext& context, const LaneModel& model, const VectorXd& point)
      : context_(context),
        model_(model),
        derivative_(model.problem.derivative),
        output_(model.problem.output),
        start_(model.start),
        point_(point),
        system_(context, true),
        outputs_(context.model.outputs, context.names, context.numbers.updNumbers()),
        state_(system_.getTree().getDefaultState()) {}

  std::string compareAt(const InitialState& at, double time) {
    setState(system_, at, state_);
    const double begin = beginPhase(time);
    const VectorXd accelerations = calcAccelerations(time);
    ProgramInputs inputs{point_, collectStates(at), collectPhaseInputs(begin), time};
    const Eigen::Index n = at.coordinates.size();
    const std::string difference =
        compare("acceleration of", context_.names.getCoordinateNames(),
                derivative_.calc(inputs).segment(n, n), accelerations, inputs.states.tail(n).squaredNorm());
    return difference.empty() ? compareOutputs(inputs) : difference;
  }

 private:
  VectorXd calcEvents() {
    return start_.calc({point_}).segment(model_.counts.states, model_.excitation.events.size());
  }

  double beginPhase(double time) {
    const VectorXd events = calcEvents();
    double begin = 0.0;
    for (const Boundary& boundary : calcBoundaries(model_.excitation, {events.begin(), events.end()},
                                                   context_.model.simulation.duration)) {
      begin = boundary.time <= time ? boundary.time : begin;
    }
    context_.excitation.mute();
    context_.excitation.beginPhase(begin);
    return begin;
  }

  VectorXd calcAccelerations(double time) {
    state_.setTime(time);
    system_.getTree().getSystem().realize(state_, SimTK::Stage::Acceleration);
    const std::vector<BodyTree::Slot>& slots = system_.getTree().getSlots();
    return VectorXd::NullaryExpr(static_cast<Eigen::Index>(slots.size()),
                                 [&](Eigen::Index i) { return state_.getUDot()[slots[i].u]; });
  }

  VectorXd collectStates(const InitialState& at) const {
    const std::vector<BodyTree::Slot>& slots = system_.getTree().getSlots();
    VectorXd states(2 * at.coordinates.size());
    states.head(at.coordinates.size()) = at.coordinates;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      states[at.coordinates.size() + static_cast<Eigen::Index>(i)] = state_.getU()[slots[i].u];
    }
    return states;
  }

  VectorXd collectPhaseInputs(double begin) {
    const VectorXd events = calcEvents();
    VectorXd inputs(model_.excitation.input_count);
    fillPhaseInputs(model_.excitation, {events.begin(), events.end()}, begin, inputs.data());
    return inputs;
  }

  std::string compareOutputs(const ProgramInputs& inputs) {
    VectorXd expected(static_cast<Eigen::Index>(context_.model.outputs.size()));
    outputs_.calc(system_, state_, inputs.time, expected.data(), 1);
    std::vector<std::string> names;
    for (const OutputSpec& output : context_.model.outputs) {
      names.push_back(output.name.text);
    }
    return compare("output", names, output_.calc(inputs).head(expected.size()), expected,
                   inputs.states.tail(inputs.states.size() / 2).squaredNorm());
  }

  ModelContext& context_;
  const LaneModel& model_;
  SingleProgram derivative_, output_, start_;
  VectorXd point_;
  LoadedSystem system_;
  Outputs outputs_;
  SimTK::State state_;
};

std::string compareAtPoint(ModelContext& context, const LaneModel& model, const VectorXd& point,
                           Draws& draws) {
  context.numbers.update(point);
  Comparison comparison(context, model, point);
  const VectorXd start = calcInitialValues(context).coordinates;
  const VectorXd half = VectorXd::Constant(start.size(), 0.5), two = 4.0 * half;  // m or rad; and a second
  for (int i = 0; i < kStates; ++i) {
    const InitialState at{draws.draw(start - half, start + half), draws.draw(-two, two)};
    const std::string difference =
        comparison.compareAt(at, draws.draw(0.0, std::max(context.model.simulation.duration, 1e-3)));
    if (!difference.empty()) {
      return difference;
    }
  }
  return "";
}

}  // namespace

std::string compareWithSimbody(ModelContext& context, const LaneModel& model) {
  const std::vector<ParameterSpec> sampled = collectSampled(context.model);
  const VectorXd lower = calcLowerBounds(sampled), upper = lower + calcWidths(sampled);
  Draws draws;
  for (int i = 0; i < kPoints; ++i) {
    try {
      const std::string difference = compareAtPoint(context, model, draws.draw(lower, upper), draws);
      if (!difference.empty()) {
        return difference;
      }
    } catch (const SimulationFailure&) {
      continue;  // no such system can be simulated, by neither
    } catch (const SimTK::Exception::Base&) {
      continue;
    }
  }
  return "";
}

}  // namespace twinmap
