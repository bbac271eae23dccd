#include "framework/models/mechanism/model_context.hpp"

#include <algorithm>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/constraint_numbers.hpp"
#include "framework/models/mechanism/load_numbers.hpp"
#include "framework/models/mechanism/switch_numbers.hpp"
#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {

namespace {

Eigen::VectorXd calcNamed(const std::vector<NamedExpression>& values, const char* what,
                          ModelContext& context) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(context.names.getCoordinateNames().size());
  for (const NamedExpression& value : values) {
    const std::string owner = "initial condition of '" + value.name.text + "'";
    result[context.names.findCoordinate(value.name)] = context.numbers.calc(value.value, {owner, what, ""});
  }
  return result;
}

/// Those of elements have their numbers checked with the elements'.
Eigen::VectorXd calcInitialStates(ModelContext& context) {
  std::vector<double> values;
  for (const StateSpec& state : context.model.system.states) {
    values.push_back(context.numbers.calc(state.initial, {"state '" + state.name.text + "'", "initial", ""}));
  }
  context.model.system.elements.forEachList([&](const auto& list) {
    for (const auto& element : list) {
      forEachOwnState(element, [&](const auto& part, const Name& coordinate) {
        values.push_back(
            context.numbers.calc(part.initial, {"state on '" + coordinate.text + "'", "initial", ""}));
      });
    }
  });
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double calcNonNegative(const Expression& expression, const Quantity& quantity, ModelNumbers& numbers) {
  const double value = expression.text.empty() ? 0.0 : numbers.calc(expression, quantity);
  if (value < 0.0) {
    throwUnusable(quantity, value, "must not be negative", expression.where);
  }
  return value;
}

void checkSensor(const SensorSpec& sensor, const std::string& owner, ModelNumbers& numbers) {
  if (!sensor.lag.text.empty()) {
    numbers.calcPositive(sensor.lag, {owner, "sensor.lag", "s"});
  }
  if (!sensor.average.text.empty()) {
    numbers.calcPositive(sensor.average, {owner, "sensor.average", "s"});
  }
  if (sensor.filter) {
    numbers.calcPositive(sensor.filter->cutoff, {owner, "sensor.filter.cutoff", "Hz"});
  }
}

bool isReadByControllers(const OutputSpec& output, const SystemSpec& system) {
  return std::any_of(
      system.controllers.begin(), system.controllers.end(), [&](const ControllerSpec& controller) {
        return std::any_of(controller.reads.begin(), controller.reads.end(), [&](const ReadingSpec& reading) {
          return reading.source.text == output.name.text;
        });
      });
}

void checkSampledNumbers(const ModelSpec& model, ModelNumbers& numbers) {
  for (const OutputSpec& output : model.outputs) {
    if (output.sensor) {
      const std::string owner = "output '" + output.name.text + "'";
      checkSensor(*output.sensor, owner, numbers);
      if (isReadByControllers(output, model.system)) {  // a recorder's clock may be early
        calcNonNegative(output.sensor->delay, {owner, "sensor.delay", "s"}, numbers);
      }
    }
  }
  for (const ControllerSpec& controller : model.system.controllers) {
    const std::string owner = "controller '" + controller.name.text + "'";
    calcNonNegative(controller.delay, {owner, "delay", "s"}, numbers);
  }
}

int findParameter(const ModelSpec& model, const Name& name) {
  const std::vector<std::string> names = collectNames(collectSampled(model));
  requireKnown(name, names, "a parameter");
  return static_cast<int>(std::find(names.begin(), names.end(), name.text) - names.begin());
}

}  // namespace

InitialState calcInitialValues(ModelContext& context) {
  const InitialSpec& initial = context.model.initial;
  return {calcNamed(initial.coordinates, "coordinate", context), calcNamed(initial.speeds, "speed", context),
          calcInitialStates(context)};
}

Eigen::VectorXd calcEquilibriumPoint(ModelContext& context) {
  Eigen::VectorXd point = calcBoxCenter(collectSampled(context.model));
  for (const NamedExpression& value : context.model.initial.equilibrium->parameters) {
    const std::string owner = "initial.equilibrium";
    point[findParameter(context.model, value.name)] =
        context.numbers.calc(value.value, {owner, value.name.text.c_str(), ""});
  }
  return point;
}

std::vector<NumberCheck> listNumberChecks(const ModelSpec& model) {
  std::vector<NumberCheck> checks;
  const auto add = [&checks](bool only_finite, std::function<void(ModelContext&)> check) {
    checks.push_back({only_finite, std::move(check)});
  };
  for (const BodySpec& body : model.system.bodies) {
    add(false, [&body](ModelContext& context) { calcMassNumbers(body, context.numbers); });
    add(false, [&body](ModelContext& context) { calcJointNumbers(body, context.numbers); });
  }
  for (const ArmatureSpec& armature : model.system.armature) {
    add(false, [&armature](ModelContext& context) { checkArmature(armature, context.numbers); });
  }
  for (const CurveSpec& curve : model.system.curves) {
    add(true, [&curve](ModelContext& context) {
      for (const Expression& value : curve.values) {
        context.numbers.calc(value, {"curve '" + curve.name.text + "'", "values", curve.unit.c_str()});
      }
    });
  }
  add(true,
      [](ModelContext& context) { calcLoadNumbers(context.model.system, context.names, context.numbers); });
  add(false, [](ModelContext& context) {
    calcConstraintNumbers(context.model.system, context.names, context.numbers);
  });
  add(false, [](ModelContext& context) { context.excitation.update(context.numbers); });
  for (const OutputSpec& output : model.outputs) {
    add(false,
        [&output](ModelContext& context) { calcOutputNumbers(output, context.names, context.numbers); });
  }
  add(false, [](ModelContext& context) { checkSampledNumbers(context.model, context.numbers); });
  add(false, [](ModelContext& context) { checkSwitchNumbers(context.model.system, context.numbers); });
  add(true, [](ModelContext& context) { calcInitialValues(context); });
  return checks;
}

void checkNumbers(ModelContext& context) {
  for (const NumberCheck& one : listNumberChecks(context.model)) {
    one.check(context);
  }
}

}  // namespace twinmap
