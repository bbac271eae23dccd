#include "framework/models/mechanism/simbody/box_center.hpp"

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/simbody/initial_state.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"

namespace twinmap {
namespace {

/// What is wrong with the model at the centre of its box, with the number that is the cause, or `system`.
ExperimentError makeCenterError(const ModelSpec& model, SourceLocation where, const std::string& reason) {
  if (where.file.empty() && !model.system.bodies.empty()) {
    where = model.system.bodies.front().name.where;
    where.key_path = where.file.empty() ? "" : "system";
  }
  const std::string place = toString(where);
  return ExperimentError((place.empty() ? "" : place + ": ") + "at the centre of the bounds: " + reason);
}

/// With the context's numbers at the box centre. What fails in `action` is wrong input.
template <typename Action>
void atBoxCenter(SimbodyContext& context, const Action& action) {
  try {
    context.numbers.update(calcBoxCenter(collectSampled(context.model)));
    action();
  } catch (const SimulationFailure& failure) {
    throw makeCenterError(context.model, failure.getWhere(), failure.what());
  } catch (const SimTK::Exception::Base& error) {
    std::string message = error.getMessage();
    std::replace(message.begin(), message.end(), '\n', ' ');
    throw makeCenterError(context.model, {}, "Simbody: " + message);
  }
}

void checkInitialState(SimbodyContext& context, const Eigen::VectorXd& box_center) {
  LoadedSystem system(context, false);
  SimTK::State state = system.getTree().getDefaultState();
  setState(system, calcInitialState(context, system, box_center), state);
  context.excitation.beginPhase(0.0);
  const bool finite = system.calcUDot(state, 0.0).allFinite();
  const std::vector<double>& rates = system.getStateRates();
  const auto isFinite = [](double rate) { return std::isfinite(rate); };
  context.excitation.mute();
  if (!finite) {
    throw SimulationFailure("the accelerations of the initial state are not finite");
  }
  if (!std::all_of(rates.begin(), rates.end(), isFinite)) {
    throw SimulationFailure("the rates of the states of first order are not finite at the start");
  }
}

}  // namespace

void buildAtBoxCenter(SimbodyContext& context) {
  atBoxCenter(context, [&] {
    const LoadedSystem system(context, false);
    const Outputs outputs(context.model.outputs, context.names, context.numbers);
    checkNumbers(context);  // with those that no system is built of
  });
}

Eigen::VectorXd solveBoxCenter(SimbodyContext& context) {
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  Eigen::VectorXd coordinates;
  if (equilibrium && equilibrium->at == EquilibriumAt::kBoxCenter) {
    atBoxCenter(context, [&] {
      context.numbers.update(calcEquilibriumPoint(context));
      LoadedSystem system(context, false);
      coordinates = solveEquilibrium(system, assemble(context, calcInitialValues(context)).getEquilibrium());
    });
  }
  return coordinates;
}

void checkStartAtBoxCenter(SimbodyContext& context, const Eigen::VectorXd& box_center) {
  atBoxCenter(context, [&] { checkInitialState(context, box_center); });
}

}  // namespace twinmap
