#include "framework/models/mechanism/system_numbers.hpp"

#include <cmath>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/expression/output_units.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/constraint_numbers.hpp"
#include "framework/models/mechanism/load_numbers.hpp"
#include "framework/models/mechanism/model_context.hpp"
#include "framework/models/mechanism/switch_numbers.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Vector3d;

/// A moment may break a rule by this much of the largest one: rounding of thin plates and rods.
constexpr double kInertiaSlack = 1e-9;

Vector3d calcPrincipalMoments(const Vector3d& moments, const Vector3d& products) {
  Eigen::Matrix3d tensor;
  tensor << moments[0], products[0], products[1],  //
      products[0], moments[1], products[2],        //
      products[1], products[2], moments[2];
  return linalg::calcSymmetricEigenvalues(tensor);
}

void checkInertia(const std::string& owner, const Vector3d& principal, const SourceLocation& where) {
  const double slack = kInertiaSlack * principal.cwiseAbs().maxCoeff();
  if (principal[0] < -slack) {
    throwUnusable({owner, "inertia: smallest principal moment", "kg m2"}, principal[0],
                  "must not be negative", where);
  }
  if (principal[2] > principal[0] + principal[1] + slack) {
    throwUnusable({owner, "inertia: largest principal moment", "kg m2"}, principal[2],
                  "must not exceed the sum of the other two (of a body that turns about one axis alone, only "
                  "the moment J about that axis acts: write [J, J, J])",
                  where);
  }
}

/// Accelerations need m c^2 and 1 / m, which must be numbers.
void checkRange(const BodySpec& body, const std::string& owner, double mass, const Vector3d& center) {
  if (!std::isfinite(1.0 / mass)) {
    throwUnusable({owner, "mass", "kg"}, mass, "is too small: its inverse must be finite", body.mass.where);
  }
  if (!std::isfinite(mass * center.squaredNorm())) {
    throwUnusable({owner, "center_of_mass", "m"}, center.stableNorm(),
                  "is too far away: the inertia about the body's origin must be finite",
                  body.center_of_mass[0].where);
  }
}

std::string findUnit(const OutputSpec& output, const SystemNames& names) {
  if (!output.expression.text.empty()) {
    return output.unit;
  }
  if (output.reaction || output.component) {
    return getForceUnit(output.reaction ? output.reaction->component : *output.component);
  }
  if (output.force_of) {
    const std::optional<Name> on = names.findForce(*output.force_of).coordinate;
    return getForceUnit(on ? names.getCoordinates()[names.findCoordinate(*on)].traits.kind
                           : CoordinateKind::kTranslation);
  }
  const std::optional<Name>& coordinate = output.coordinate ? output.coordinate : output.speed;
  return getOutputUnit(output, coordinate
                                   ? names.getCoordinates()[names.findCoordinate(*coordinate)].traits.kind
                                   : CoordinateKind{});
}

void checkOne(const OutputSpec& output) {
  const int count = output.coordinate.has_value() + output.speed.has_value() + output.position.has_value() +
                    output.velocity.has_value() + output.acceleration.has_value() +
                    output.specific_force.has_value() + output.angular_velocity.has_value() +
                    output.reaction.has_value() + output.force_of.has_value() +
                    (output.expression.text.empty() ? 0 : 1);
  if (count != 1) {
    throw ExperimentError(output.name.where, output.name.text,
                          "must measure one of coordinate, speed, position, velocity, acceleration, "
                          "specific_force, angular_velocity, reaction, force_of, expression");
  }
}

Vector3d calcDirection(const Expression3& given, ModelNumbers& numbers, const std::string& owner) {
  const Vector3d direction = calcVector(numbers, given, {owner, "direction", ""});
  const double length = std::sqrt(direction.squaredNorm());
  if (length == 0.0) {
    throw SimulationFailure(owner + ": direction must not be zero", given[0].where);
  }
  return direction / length;
}

OutputNumbers calcQuantity(const OutputSpec& spec, const SystemNames& names, ModelNumbers& numbers,
                           const std::string& owner) {
  if (spec.coordinate || spec.speed) {
    const Name& name = spec.coordinate ? *spec.coordinate : *spec.speed;
    const OutputKind kind = spec.coordinate ? OutputKind::kCoordinate : OutputKind::kSpeed;
    return {kind, names.findCoordinate(name), {0, Vector3d::Zero()}, Vector3d::Zero(), nullptr, {}};
  }
  if (!spec.expression.text.empty()) {
    return {OutputKind::kExpression, -1, {0, Vector3d::Zero()}, Vector3d::Zero(), &spec.expression, {}};
  }
  if (spec.reaction) {
    return {OutputKind::kReaction,   -1,      {names.findJoint(spec.reaction->joint), Vector3d::Zero()},
            Vector3d::Zero(),        nullptr, {},
            spec.reaction->component};
  }
  if (spec.force_of) {
    return {OutputKind::kForce,
            -1,
            {0, Vector3d::Zero()},
            Vector3d::Zero(),
            nullptr,
            {},
            spec.component,
            &names.findForce(*spec.force_of)};
  }
  if (spec.specific_force || spec.angular_velocity) {
    const BodySensorSpec& at = spec.specific_force ? *spec.specific_force : *spec.angular_velocity;
    const OutputKind kind = spec.specific_force ? OutputKind::kSpecificForce : OutputKind::kAngularVelocity;
    const BodyPoint point = calcBodyPoint(at.station, names, numbers, owner);
    return {kind, -1, point, calcDirection(at.direction, numbers, owner), nullptr, {}};
  }
  const StationOutputSpec& at = spec.position   ? *spec.position
                                : spec.velocity ? *spec.velocity
                                                : *spec.acceleration;
  const OutputKind kind = spec.position   ? OutputKind::kPosition
                          : spec.velocity ? OutputKind::kVelocity
                                          : OutputKind::kAcceleration;
  const BodyPoint station = calcBodyPoint(at.station, names, numbers, owner);
  return {kind, -1, station, calcDirection(at.direction, numbers, owner), nullptr, {}};
}

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

Vector3d calcVector(ModelNumbers& numbers, const Expression3& expressions, const Quantity& quantity) {
  const std::array<double, 3> values = numbers.calc3(expressions, quantity);
  return {values[0], values[1], values[2]};
}

FrameNumbers calcFrame(const FrameSpec& frame, ModelNumbers& numbers, const std::string& owner) {
  const Vector3d angles = calcVector(numbers, frame.orientation, {owner, "orientation", "rad"});
  return {calcVector(numbers, frame.point, {owner, "point", "m"}), angles};
}

MassNumbers calcMassNumbers(const BodySpec& body, ModelNumbers& numbers) {
  const std::string owner = "body '" + body.name.text + "'";
  MassNumbers mass{};
  mass.mass = numbers.calcPositive(body.mass, {owner, "mass", "kg"});
  mass.center = calcVector(numbers, body.center_of_mass, {owner, "center_of_mass", "m"});
  const Expression& about_axis = body.inertia.about_axis;
  mass.moments = about_axis.text.empty()
                     ? calcVector(numbers, body.inertia.moments, {owner, "inertia.moments", "kg m2"})
                     : Vector3d::Constant(numbers.calc(about_axis, {owner, "inertia", "kg m2"}));
  mass.products = calcVector(numbers, body.inertia.products, {owner, "inertia.products", "kg m2"});
  checkRange(body, owner, mass.mass, mass.center);
  checkInertia(owner, calcPrincipalMoments(mass.moments, mass.products),
               about_axis.text.empty() ? body.inertia.moments[0].where : about_axis.where);
  return mass;
}

JointNumbers calcJointNumbers(const BodySpec& body, ModelNumbers& numbers) {
  const std::string owner = "body '" + body.name.text + "'";
  JointNumbers joint;
  if (body.joint.axis) {
    joint.axis = calcVector(numbers, *body.joint.axis, {owner, "joint.axis", ""});
    if (joint.axis->squaredNorm() == 0.0) {
      throw SimulationFailure(owner + ": joint.axis must not be zero", (*body.joint.axis)[0].where);
    }
  }
  joint.in_parent = calcFrame(body.joint.in_parent, numbers, owner);
  joint.in_body = calcFrame(body.joint.in_body, numbers, owner);
  if (getTraits(body.joint.type).has_pitch) {
    joint.pitch = numbers.calc(body.joint.pitch, {owner, "joint.pitch", "m/rad"});
  }
  return joint;
}

BodyPoint calcBodyPoint(const StationSpec& spec, const SystemNames& names, ModelNumbers& numbers,
                        const std::string& owner) {
  return {names.findBody(spec.body), calcVector(numbers, spec.point, {owner, "point", "m"})};
}

std::vector<std::string> getOutputUnits(const std::vector<OutputSpec>& outputs, const SystemNames& names) {
  std::vector<std::string> units;
  for (const OutputSpec& output : outputs) {
    checkOne(output);
    units.emplace_back(findUnit(output, names));
  }
  return units;
}

OutputNumbers calcOutputNumbers(const OutputSpec& spec, const SystemNames& names, ModelNumbers& numbers) {
  const std::string owner = "output '" + spec.name.text + "'";
  OutputNumbers output = calcQuantity(spec, names, numbers, owner);
  const std::string unit = findUnit(spec, names);
  const bool has_gain = !spec.gain.text.empty(), has_offset = !spec.offset.text.empty();
  if (has_gain || has_offset) {
    output.sensor = {has_gain ? numbers.calc(spec.gain, {owner, "gain", ""}) : 1.0,
                     has_offset ? numbers.calc(spec.offset, {owner, "offset", unit.c_str()}) : 0.0};
  }
  return output;
}

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
