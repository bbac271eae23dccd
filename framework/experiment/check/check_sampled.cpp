#include "framework/experiment/check/check_sampled.hpp"

#include <algorithm>

#include "framework/experiment/check/field_check.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/output_units.hpp"

namespace twinmap {
namespace {

const std::string kDifference = "difference(";

template <class Items>
std::vector<std::string> listNamesOf(const Items& items) {
  std::vector<std::string> names;
  for (const auto& item : items) {
    names.push_back(item.name.text);
  }
  return names;
}

void checkSensors(const ModelSpec& model) {
  for (const OutputSpec& output : model.outputs) {
    if (output.sensor && output.variable) {
      throw ExperimentError(output.name.where, output.name.text,
                            "is a variable of a model from elsewhere, which has no sensor here; let that "
                            "model have it");
    }
  }
}

/// A signal that is smooth but for where a term begins: what moves as it says needs its acceleration.
void requireSmooth(const SignalSpec& signal, const Name& motion) {
  const auto refuse = [&](bool refused, const std::string& what) {
    if (refused) {
      throw ExperimentError(motion.where, motion.text, "cannot prescribe a motion: " + what);
    }
  };
  refuse(!signal.pulses.empty(), "its pulses jump");
  for (const TableSpec& table : signal.tables) {
    refuse(table.interpolation == TableInterpolation::kHold, "its table holds its values, so that it jumps");
    refuse(table.interpolation == TableInterpolation::kLinear,
           "the speed of its linear table jumps at every sample; take 'interpolation: cubic'");
  }
}

class MotionCheck {
 public:
  explicit MotionCheck(const ModelSpec& model) : model_(model) {}

  void run() const {
    std::vector<std::string> moved;
    for (const MotionSpec& motion : model_.system.motions) {
      if (std::find(moved.begin(), moved.end(), motion.coordinate.text) != moved.end()) {
        throw ExperimentError(motion.coordinate.where, motion.coordinate.text,
                              "follows another signal already");
      }
      moved.push_back(motion.coordinate.text);
      check(motion);
    }
  }

 private:
  void check(const MotionSpec& motion) const {
    requireKnown(motion.follows, listNamesOf(model_.excitation), "a signal of the excitation");
    const SignalSpec& signal =
        *std::find_if(model_.excitation.begin(), model_.excitation.end(),
                      [&](const SignalSpec& spec) { return spec.name.text == motion.follows.text; });
    requireSmooth(signal, motion.follows);
    OutputSpec coordinate;
    coordinate.coordinate = motion.coordinate;
    const std::string unit = findOutputUnit(coordinate, model_.system);
    const auto wanted = parseUnit(unit, motion.coordinate.where);
    if (!signal.unit.empty() && parseUnit(signal.unit, signal.name.where) != wanted) {
      throw ExperimentError(motion.follows.where, motion.follows.text,
                            "is in " + signal.unit + ", but '" + motion.coordinate.text + "' in " + unit);
    }
  }

  const ModelSpec& model_;
};

class ControllerCheck {
 public:
  ControllerCheck(const ModelSpec& model, const CheckScope& constants)
      : model_(model), constants_(constants), common_(constants) {
    constexpr double kSomeSignal = 0.71, kSomeRate = 0.83;
    for (const SignalSpec& signal : model.excitation) {
      common_.define(signal.name, CheckScope::readUnit(signal.unit, signal.name.where), kSomeSignal);
      const std::string rate = makeRateUnit(signal.unit);
      common_.define({signal.name.text + "_dot", signal.name.where},
                     CheckScope::readUnit(rate, signal.name.where), kSomeRate);
      common_.define({signal.name.text + "_ddot", signal.name.where},
                     CheckScope::readUnit(makeRateUnit(rate), signal.name.where), kSomeRate);
    }
    common_.defineTime();
    defineHeld(model.system.controllers, common_);
  }

  void check(const ControllerSpec& controller) const {
    constants_.check(controller.delay, "s");
    CheckScope scope = common_;
    constexpr double kSomeReading = 0.59;
    for (const ReadingSpec& reading : controller.reads) {
      const std::string unit = findUnit(reading.source);
      scope.define(reading.name, CheckScope::readUnit(unit, reading.source.where), kSomeReading);
    }
    for (const DiscreteStateSpec& state : controller.states) {
      constants_.check(state.initial, state.unit);
      check(state.next, state.unit, scope);
    }
    for (const ControllerOutputSpec& output : controller.writes) {
      constants_.check(output.initial, output.unit);
      check(output.value, output.unit, scope);
    }
  }

 private:
  std::string findUnit(const Name& source) const {
    for (const OutputSpec& output : model_.outputs) {
      if (output.name.text == source.text) {
        return findOutputUnit(output, model_.system);
      }
    }
    std::vector<std::string> known = listNamesOf(model_.outputs);
    for (const BodySpec& body : model_.system.bodies) {
      for (const Name& coordinate : body.joint.coordinates) {
        known.push_back(coordinate.text);
      }
    }
    requireKnown(source, known, "an output or a coordinate");
    OutputSpec coordinate;
    coordinate.coordinate = source;
    return findOutputUnit(coordinate, model_.system);
  }

  /// With what the expression takes differences of; the inner ones come first.
  static void check(const Expression& expression, const std::string& unit, CheckScope& scope) {
    for (const std::string& name : getUsedNames(expression)) {
      const std::vector<std::string>& known = scope.getNames();
      if (name.rfind(kDifference, 0) == 0 && std::find(known.begin(), known.end(), name) == known.end()) {
        const std::string inside = name.substr(kDifference.size(), name.size() - kDifference.size() - 1);
        scope.defineDifference({name, expression.where}, {inside, expression.where});
      }
    }
    scope.check(expression, unit);
  }

  const ModelSpec& model_;
  const CheckScope& constants_;
  CheckScope common_;
};

}  // namespace

void defineHeld(const std::vector<ControllerSpec>& controllers, CheckScope& scope) {
  constexpr double kSomeValue = 0.43;
  for (const ControllerSpec& controller : controllers) {
    for (const ControllerOutputSpec& output : controller.writes) {
      scope.define(output.name, CheckScope::readUnit(output.unit, output.name.where), kSomeValue);
    }
    for (const DiscreteStateSpec& state : controller.states) {
      scope.define(state.name, CheckScope::readUnit(state.unit, state.name.where), kSomeValue);
    }
  }
}

void checkSampled(const ModelSpec& model, const CheckScope& constants) {
  checkSensors(model);
  MotionCheck(model).run();
  if (model.system.controllers.empty()) {
    return;
  }
  const ControllerCheck check(model, constants);
  for (const ControllerSpec& controller : model.system.controllers) {
    check.check(controller);
  }
}

}  // namespace twinmap
