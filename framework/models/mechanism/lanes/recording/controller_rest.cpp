#include "framework/models/mechanism/lanes/recording/controller_rest.hpp"

#include <algorithm>

#include "framework/models/mechanism/lanes/recording/recorded_sensor.hpp"
#include "framework/models/mechanism/varying_expressions.hpp"
#include "kernels/lanes/program/differentiate.hpp"

namespace twinmap {
namespace {

using equations::ModelState;
using program::Symbol;
using Symbols = std::vector<Symbol>;

class RestRecorder {
 public:
  RestRecorder(const ModelSpec& model, const SystemNames& names, const NamedValues<Symbol>& numbers,
               const ModelState<Symbol>& rest, const Symbols& quantities)
      : model_(model), names_(names), rest_(rest), quantities_(quantities), common_(numbers) {
    variables_ = rest.coordinates;
    variables_.insert(variables_.end(), rest.states.begin(), rest.states.end());
    for (const SignalSpec& signal : model.excitation) {
      common_.set(signal.name.text, Symbol(0.0));
    }
    for (const std::string& rate : nameSignalRates(model.excitation, 2)) {
      common_.set(rate, Symbol(0.0));
    }
    common_.set("t", Symbol(0.0));
    for (const ControllerSpec& controller : model.system.controllers) {
      for (const DiscreteStateSpec& state : controller.states) {
        common_.set(state.name.text, rest.states[findState(state.name)]);
      }
      for (const ControllerOutputSpec& output : controller.writes) {
        common_.set(output.name.text, rest.states[findState(output.name)]);
      }
    }
  }

  void add(const ControllerSpec& controller, Symbols& rates) const {
    NamedValues<Symbol> scope = common_;
    for (const ReadingSpec& reading : controller.reads) {
      scope.set(reading.name.text, read(reading));
    }
    for (const DiscreteStateSpec& state : controller.states) {
      set(state.name, state.next, scope, rates);
    }
    for (const ControllerOutputSpec& output : controller.writes) {
      set(output.name, output.value, scope, rates);
    }
  }

 private:
  std::size_t findState(const Name& name) const {
    const std::vector<std::string>& states = names_.getStateNames();
    return static_cast<std::size_t>(std::find(states.begin(), states.end(), name.text) - states.begin());
  }

  Symbol read(const ReadingSpec& reading) const {
    const auto found =
        std::find_if(model_.outputs.begin(), model_.outputs.end(),
                     [&](const OutputSpec& output) { return output.name.text == reading.source.text; });
    if (found == model_.outputs.end()) {
      return rest_.coordinates[names_.findCoordinate(reading.source)];
    }
    const Symbol& quantity = quantities_[static_cast<std::size_t>(found - model_.outputs.begin())];
    return found->sensor ? clip(*found->sensor, quantity) : quantity;
  }

  void set(const Name& name, const Expression& next, NamedValues<Symbol> scope, Symbols& rates) const {
    for (const std::string& used : getUsedNames(next)) {
      if (used.rfind("difference(", 0) == 0) {
        scope.set(used, Symbol(0.0));
      }
    }
    const std::size_t place = findState(name);
    const Symbol left = scope.calc(next) - rest_.states[place];
    const std::vector<Symbols> slopes = program::calcJacobian({left}, variables_);
    const bool depends =
        std::any_of(slopes.begin(), slopes.end(), [](const Symbols& one) { return !one[0].isLiteral(0.0); });
    rates[place] = depends ? left : Symbol(0.0);
  }

  const ModelSpec& model_;
  const SystemNames& names_;
  const ModelState<Symbol>& rest_;
  const Symbols& quantities_;
  NamedValues<Symbol> common_;
  Symbols variables_;
};

}  // namespace

void addControllersAtRest(const ModelSpec& model, const SystemNames& names,
                          const NamedValues<Symbol>& numbers, const ModelState<Symbol>& rest,
                          const Symbols& quantities, Symbols& rates) {
  const RestRecorder recorder(model, names, numbers, rest, quantities);
  for (const ControllerSpec& controller : model.system.controllers) {
    recorder.add(controller, rates);
  }
}

}  // namespace twinmap
