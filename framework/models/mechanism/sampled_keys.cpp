#include "framework/models/mechanism/sampled_keys.hpp"

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"

namespace twinmap {
namespace {

void addStill(SystemSpec& system, const Name& name, const Expression& initial, const std::string& unit) {
  const bool known = std::any_of(system.states.begin(), system.states.end(),
                                 [&](const StateSpec& state) { return state.name.text == name.text; });
  if (!known) {
    system.states.push_back({name, {"0", name.where}, initial, unit});
  }
}

}  // namespace

int findSignal(const ModelSpec& model, const Name& signal) {
  std::vector<std::string> names;
  for (const SignalSpec& spec : model.excitation) {
    names.push_back(spec.name.text);
  }
  const auto found = std::find(names.begin(), names.end(), signal.text);
  if (found == names.end()) {
    throw ExperimentError(signal.where, signal.text,
                          "is not a signal of the excitation" + suggestName(signal.text, names));
  }
  return static_cast<int>(found - names.begin());
}

ModelSpec addControllerStates(ModelSpec model) {
  for (const ControllerSpec& controller : model.system.controllers) {
    for (const ControllerOutputSpec& output : controller.writes) {
      addStill(model.system, output.name, output.initial, output.unit);
    }
    for (const DiscreteStateSpec& state : controller.states) {
      addStill(model.system, state.name, state.initial, state.unit);
    }
  }
  return model;
}

ModelSpec removeSampled(ModelSpec model) {
  model.system.controllers.clear();
  if (!model.system.motions.empty()) {
    model.system.motions.clear();
    model.initial.equilibrium.reset();  // where a table hangs on nothing there is none
  }
  for (OutputSpec& output : model.outputs) {
    output.sensor.reset();
  }
  return model;
}

std::string findSampledKey(const ModelSpec& model) {
  if (!model.system.motions.empty()) {
    return "system.motions";
  }
  if (!model.system.controllers.empty()) {
    return "system.controllers." + model.system.controllers.front().name.text;
  }
  const auto found = std::find_if(model.outputs.begin(), model.outputs.end(),
                                  [](const OutputSpec& output) { return output.sensor.has_value(); });
  return found == model.outputs.end() ? "" : "outputs." + found->name.text + ".sensor";
}

}  // namespace twinmap
