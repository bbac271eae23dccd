#include "framework/models/mechanism/sampled_keys.hpp"

#include <algorithm>

#include "framework/base/text/nearest_name.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/named_forces.hpp"

namespace twinmap {
namespace {

void addStill(SystemSpec& system, const Name& name, const Expression& initial, const std::string& unit) {
  const bool known = std::any_of(system.states.begin(), system.states.end(),
                                 [&](const StateSpec& state) { return state.name.text == name.text; });
  if (!known) {
    system.states.push_back({name, {"0", name.where}, initial, unit});
  }
}

template <class Items, class Rule>
void removeIf(Items& items, Rule rule) {
  items.erase(std::remove_if(items.begin(), items.end(), rule), items.end());
}

/// Takes elements that switch out, and what outputs show of them; dampers that begin at a touch, out of
/// theirs.
void removeSwitches(ModelSpec& model) {
  ForceElements<Expression>& elements = model.system.elements;
  removeIf(elements.get<Stop>(), [](const auto& stop) { return stop.isRigid(); });
  removeIf(elements.get<Friction>(), [](const auto& friction) { return friction.switches(); });
  for (Stop<Expression>& stop : elements.get<Stop>()) {
    stop.damping.reset();
  }
  for (Contact<Expression>& contact : elements.get<Contact>()) {
    contact.damping.reset();
  }
  for (OutputSpec& output : model.outputs) {
    if (output.force_of && !findNamedForce(model.system, output.force_of->text)) {
      output.expression = {"0", output.force_of->where};
      output.unit = "1";
      output.force_of.reset();
      output.component.reset();
    }
  }
}

/// Of the first that satisfies a rule, "system.stops[1].restitution"; "" if none does.
template <class Items, class Rule>
std::string findElementKey(const Items& items, Rule rule, const char* key, const char* value) {
  const auto found = std::find_if(items.begin(), items.end(), rule);
  return found == items.end()
             ? ""
             : std::string("system.") + key + "[" + std::to_string(found - items.begin()) + "]" + value;
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
  if (!model.system.motions.empty() || !model.system.controllers.empty()) {
    model.initial.equilibrium
        .reset();  // where a table hangs on nothing, or no controller holds, there is none
  }
  model.system.motions.clear();
  model.system.controllers.clear();
  model.system.armature.clear();
  for (BodySpec& body : model.system.bodies) {
    if (isUnchecked(body.inertia)) {
      body.inertia = InertiaSpec{};  // one that exists
      body.inertia.moments.fill({"1", {}});
    }
  }
  for (OutputSpec& output : model.outputs) {
    output.sensor.reset();
  }
  removeSwitches(model);
  return model;
}

std::string findSampledKey(const ModelSpec& model) {
  if (!model.system.motions.empty()) {
    return "system.motions";
  }
  if (!model.system.controllers.empty()) {
    return "system.controllers." + model.system.controllers.front().name.text;
  }
  if (!model.system.armature.empty()) {
    return "system.armature";
  }
  for (const BodySpec& body : model.system.bodies) {
    if (isUnchecked(body.inertia)) {
      return "system.bodies." + body.name.text + ".inertia.unchecked";
    }
  }
  const auto found = std::find_if(model.outputs.begin(), model.outputs.end(),
                                  [](const OutputSpec& output) { return output.sensor.has_value(); });
  if (found != model.outputs.end()) {
    return "outputs." + found->name.text + ".sensor";
  }
  const ForceElements<Expression>& elements = model.system.elements;
  const std::string stop = findElementKey(
      elements.get<Stop>(), [](const auto& one) { return one.isRigid(); }, "stops", ".restitution");
  const std::string friction = findElementKey(
      elements.get<Friction>(), [](const auto& one) { return one.switches(); }, "friction",
      ".model: coulomb");
  const auto is_damped = [](const auto& one) { return one.damping.has_value(); };
  const std::string damped = findElementKey(elements.get<Stop>(), is_damped, "stops", ".damping");
  for (const std::string& key : {stop, friction, damped}) {
    if (!key.empty()) {
      return key;
    }
  }
  return findElementKey(elements.get<Contact>(), is_damped, "contacts", ".damping");
}

}  // namespace twinmap
