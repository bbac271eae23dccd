#include "framework/models/start_states.hpp"

#include <algorithm>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/models/mechanism/equations/switches.hpp"
#include "framework/models/mechanism/system_names.hpp"

namespace twinmap {

using Kind = StartState::Kind;

namespace {

Expression findNamed(const std::vector<NamedExpression>& values, const std::string& name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const NamedExpression& value) { return value.name.text == name; });
  return found == values.end() ? Expression{"", {}} : found->value;
}

bool isPrescribed(const ModelSpec& model, const std::string& coordinate) {
  const std::vector<MotionSpec>& motions = model.system.motions;
  return std::any_of(motions.begin(), motions.end(),
                     [&](const MotionSpec& motion) { return motion.coordinate.text == coordinate; });
}

/// Whether an expression is of parameters and constants alone.
bool isConstant(const ModelSpec& model, const Expression& expression) {
  const auto known = [](const auto& items, const std::string& name) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) { return item.name.text == name; });
  };
  const std::vector<std::string> used = getUsedNames(expression);
  return std::all_of(used.begin(), used.end(), [&](const std::string& name) {
    return known(model.parameters, name) || known(model.nuisance, name) || known(model.inputs, name) ||
           known(model.constants, name);
  });
}

template <class Element>
Expression makeReach(const ModelSpec&, const Element&) {
  return {"", {}};
}

/// A bristle slides where it carries the friction of rest, if that is known before it moves.
Expression makeReach(const ModelSpec& model, const Friction<Expression>& friction) {
  const Expression& level = getStaticLevel(friction);
  if (!isConstant(model, level)) {
    return {"", {}};
  }
  return {"(" + level.text + ") / (" + friction.bristle->stiffness.text + ")", level.where};
}

}  // namespace

std::vector<StartState> listStartStates(const ModelSpec& model) {
  const SystemNames names(model.system);
  std::vector<StartState> states;
  for (const Kind kind : {Kind::kCoordinate, Kind::kSpeed}) {
    for (const std::string& name : names.getCoordinateNames()) {
      if (!isPrescribed(model, name)) {
        const bool of_coordinate = kind == Kind::kCoordinate;
        states.push_back({name,
                          kind,
                          findNamed(of_coordinate ? model.initial.coordinates : model.initial.speeds, name),
                          {"", {}}});
      }
    }
  }
  const std::vector<std::string>& state_names = names.getStateNames();
  std::size_t next = 0;
  for (const StateSpec& state : model.system.states) {
    states.push_back({state_names[next++], Kind::kState, state.initial, {"", {}}});
  }
  model.system.elements.forEachList([&](const auto& list) {
    for (const auto& element : list) {
      forEachOwnState(element, [&](const auto& part, const Name&) {
        states.push_back({state_names[next++], Kind::kState, part.initial, makeReach(model, element)});
      });
    }
  });
  return states;
}

std::string findUnstartable(const ModelSpec& model) {
  if (model.source) {
    return "a model from elsewhere does not let be set";
  }
  if (!model.system.controllers.empty()) {
    return "the sampled controller '" + model.system.controllers.front().name.text +
           "' has beside; give what it puts out as a measured excitation";
  }
  if (!model.system.constraints.empty()) {
    return "constraints do not leave free; only trees of bodies can be inferred in segments";
  }
  if (equations::countSwitches(model.system.elements) > 0) {
    return "rigid stops, damped contacts and friction that sticks have beside; use friction: {model: "
           "regularised} or lugre";
  }
  for (const OutputSpec& output : model.outputs) {
    if (output.sensor && !output.sensor->isImmediate()) {
      return "the sensor of output '" + output.name.text + "' has beside (lag, filter, average or delay)";
    }
  }
  return "";
}

void setStartStates(const std::vector<Expression>& values, ModelSpec& model) {
  std::size_t next = 0;
  const std::vector<StartState> states = listStartStates(model);
  model.initial = {};
  for (const StartState& state : states) {
    if (state.kind != Kind::kState) {
      auto& given = state.kind == Kind::kCoordinate ? model.initial.coordinates : model.initial.speeds;
      given.push_back({{state.name, {}}, values[next++]});
    }
  }
  for (StateSpec& state : model.system.states) {
    state.initial = values[next++];
  }
  model.system.elements.forEachList([&](auto& list) {
    for (auto& element : list) {
      forEachOwnState(element, [&](auto& part, const Name&) { part.initial = values[next++]; });
    }
  });
}

}  // namespace twinmap
