#include <fmt/format.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_pairs.hpp"
#include "framework/experiment/check/check_sampled.hpp"
#include "framework/experiment/check/check_variables.hpp"
#include "framework/experiment/check/field_check.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/expression/expression_tree.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/gravity_name.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/named_forces.hpp"
#include "framework/experiment/model/output_units.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/experiment/points/prior_marginal.hpp"

namespace twinmap {
namespace {

void checkRelativeTo(const ParameterSpec& parameter) {
  const Bounds& bounds = parameter.bounds;
  if (parameter.relative_to == RelativeTo::kValue && containsZero(bounds)) {
    throw ExperimentError(bounds.where, parameter.name.text,
                          "has bounds that contain 0, where an error relative to the value is undefined; "
                          "leave out 'relative_to'");
  }
}

/// Bounds without any of the prior's central .9999 contradict it.
void checkPriorRange(const ParameterSpec& parameter) {
  if (!parameter.prior || !parameter.prior->hasRange()) {
    return;
  }
  const Bounds range = calcPriorRange(*parameter.prior);
  if (range.upper < parameter.bounds.lower || range.lower > parameter.bounds.upper) {
    throw ExperimentError(
        parameter.name.where, parameter.name.text,
        fmt::format("has a prior that lies outside its bounds: 99.99 % of it is in [{:.4g}, {:.4g}]",
                    range.lower, range.upper));
  }
}

void checkPriors(const ModelSpec& model) {
  for (const ParameterSpec& input : model.inputs) {
    if (input.prior) {
      throw ExperimentError(input.name.where, input.name.text,
                            "is a known input, given with each measurement, so that it has no prior");
    }
  }
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  for (const ParameterSpec& parameter : unknown) {
    checkPriorRange(parameter);
  }
  Prior(unknown, model.priors);
}

/// "slider, pin, screw and cylinder"
std::string listJointsWithAxis() {
  std::vector<std::string> names;
  for (const JointTraits& joint : kJoints) {
    if (joint.axis != JointAxis::kNone) {
      names.emplace_back(joint.text);
    }
  }
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// Checks every part of the model against the names declared before it.
class ModelCheck {
 public:
  explicit ModelCheck(const ModelSpec& model) : model_(model) {
    fields_.coordinates = collectCoordinates(model.system);
  }

  void run() {
    declareParameters();
    declareConstants();
    declareCurves();
    declareDynamics();
    checkJoints();
    fields_.checkAll(model_.system);
    checkPairs(model_);
    checkConstraints();
    checkNames();
    checkExcitation();
    checkInitial();
    checkOutputs();
    checkVariables(model_);
    checkSampled(model_, fields_.constants);
  }

 private:
  void declareParameters() {
    for (const ParameterSpec& parameter : collectSampled(model_)) {
      fields_.constants.define(parameter.name, CheckScope::readUnit(parameter.unit, parameter.name.where),
                               0.5 * (parameter.bounds.lower + parameter.bounds.upper));
    }
    for (const ParameterSpec& parameter : model_.parameters) {
      checkRelativeTo(parameter);
    }
    checkPriors(model_);
  }

  /// later: the constant itself and those below it.
  static void requireEarlier(const Expression& value, const std::vector<ConstantSpec>& later) {
    const std::vector<std::string> names = collectNames(later);
    for (const std::string& used : parseExpression(value).names) {
      if (std::find(names.begin(), names.end(), used) != names.end()) {
        throw ExperimentError(value.where, value.text,
                              "uses '" + used +
                                  "', which is declared only after it; a constant may use those " +
                                  "above it, and no circle of them has a value");
      }
    }
  }

  void declareConstants() {
    for (auto constant_at = model_.constants.begin(); constant_at != model_.constants.end(); ++constant_at) {
      const ConstantSpec& constant = *constant_at;
      requireEarlier(constant.value, {constant_at, model_.constants.end()});
      const double value = fields_.constants.check(constant.value, constant.unit);
      fields_.constants.define(constant.name, CheckScope::readUnit(constant.unit, constant.name.where),
                               value);
    }
  }

  void declareCurves() {
    const std::vector<CurveSpec>& curves = model_.system.curves;
    for (const CurveSpec& curve : curves) {
      for (const Expression& value : curve.values) {
        fields_.constants.check(value, curve.unit);
      }
    }
    for (const CurveSpec& curve : curves) {
      fields_.constants.defineCurve(curve.name, findDimension(curve.over),
                                    CheckScope::readUnit(curve.unit, curve.name.where));
    }
  }

  /// Of a coordinate, a speed, a state or a signal; none where no unit is stated.
  std::optional<Dimension> findDimension(const Name& name) const {
    std::vector<std::pair<std::string, std::string>> units;
    for (const Coordinate& coordinate : fields_.coordinates) {
      units.emplace_back(coordinate.name.text, coordinate.unit);
      units.emplace_back(coordinate.name.text + "_dot", coordinate.unit + "/s");
    }
    for (const SignalSpec& signal : model_.excitation) {
      units.emplace_back(signal.name.text, signal.unit);
    }
    for (const StateSpec& state : model_.system.states) {
      units.emplace_back(state.name.text, state.unit);
    }
    for (const ControllerSpec& controller : model_.system.controllers) {
      for (const ControllerOutputSpec& output : controller.writes) {
        units.emplace_back(output.name.text, output.unit);
      }
    }
    std::vector<std::string> known;
    for (const auto& [text, unit] : units) {
      known.push_back(text);
      if (text == name.text) {
        return CheckScope::readUnit(unit, name.where);
      }
    }
    requireKnown(name, known, "a coordinate, a speed, a state or a signal");
    return {};
  }

  /// Force laws also know coordinates, speeds, signals, time, states and named expressions. The reference
  /// values are arbitrary.
  void declareDynamics() {
    constexpr double kSomeCoordinate = 0.37, kSomeSpeed = 0.53, kSomeSignal = 0.71;
    fields_.dynamics = fields_.constants;
    for (const Coordinate& coordinate : fields_.coordinates) {
      fields_.dynamics.define(coordinate.name, parseUnit(coordinate.unit, {}), kSomeCoordinate);
      fields_.dynamics.define({coordinate.name.text + "_dot", coordinate.name.where},
                              parseUnit(coordinate.unit + "/s", {}), kSomeSpeed);
    }
    for (const SignalSpec& signal : model_.excitation) {
      fields_.dynamics.define(signal.name, CheckScope::readUnit(signal.unit, signal.name.where), kSomeSignal);
    }
    fields_.dynamics.defineTime();
    declareSignalRates();
    declareGravity();
    declareStates();
    for (const NamedExpression& named : model_.system.expressions) {
      fields_.dynamics.define(named.name, named.value);
    }
  }

  /// <signal>_dot and <signal>_ddot, unless something else has the name.
  void declareSignalRates() {
    for (const SignalSpec& signal : model_.excitation) {
      const std::string unit = makeRateUnit(signal.unit);
      declareUnlessTaken({signal.name.text + "_dot", signal.name.where}, unit);
      declareUnlessTaken({signal.name.text + "_ddot", signal.name.where}, makeRateUnit(unit));
    }
  }

  /// The force of gravity on a coordinate: <coordinate>_gravity.
  void declareGravity() {
    for (const Coordinate& coordinate : fields_.coordinates) {
      if (coordinate.takes_forces) {
        declareUnlessTaken({coordinate.name.text + kGravitySuffix, coordinate.name.where},
                           coordinate.unit == "m" ? getForceUnit(CoordinateKind::kTranslation)
                                                  : getForceUnit(CoordinateKind::kRotation));
      }
    }
  }

  void declareUnlessTaken(const Name& rate, const std::string& unit) {
    constexpr double kSomeRate = 0.83;
    const auto has = [&](const auto& items) {
      return std::any_of(items.begin(), items.end(),
                         [&](const auto& item) { return item.name.text == rate.text; });
    };
    const std::vector<std::string>& names = fields_.dynamics.getNames();
    if (std::find(names.begin(), names.end(), rate.text) == names.end() && !has(model_.system.states) &&
        !has(model_.system.expressions)) {
      fields_.dynamics.define(rate, unit.empty() ? std::nullopt : std::make_optional(parseUnit(unit, {})),
                              kSomeRate);
    }
  }

  void declareStates() {
    constexpr double kSomeState = 0.47;
    for (const StateSpec& state : model_.system.states) {
      fields_.dynamics.define(state.name, CheckScope::readUnit(state.unit, state.name.where), kSomeState);
    }
    defineHeld(model_.system.controllers, fields_.dynamics);
    model_.system.elements.forEachList([&](const auto& list) {
      for (const auto& element : list) {
        forEachOwnState(element, [&](const auto& part, const Name& coordinate) {
          if (part.state) {
            const std::string unit = part.kInUnitOfCoordinate ? findUnit(coordinate) : "1";
            fields_.dynamics.define(*part.state, parseUnit(unit, {}), kSomeState);
          }
        });
      }
    });
  }

  void checkConstraints() const {
    for (const ConstraintSpec& constraint : model_.system.constraints) {
      if (constraint.gear) {
        checkGear(*constraint.gear);
      } else {
        const auto [from, to] = getBodies(constraint);
        if (from.text == to.text) {
          throw ExperimentError(to.where, to.text, "must not be constrained against itself; name two bodies");
        }
      }
    }
  }

  /// Of a constraint between bodies.
  static std::pair<Name, Name> getBodies(const ConstraintSpec& constraint) {
    if (constraint.point_in_plane) {
      return {constraint.point_in_plane->plane.body, constraint.point_in_plane->station.body};
    }
    if (constraint.rolling) {
      return {constraint.rolling->plane.body, constraint.rolling->center.body};
    }
    if (constraint.weld || constraint.pin) {
      return constraint.weld ? std::pair(constraint.weld->from.body, constraint.weld->to.body)
                             : std::pair(constraint.pin->from.body, constraint.pin->to.body);
    }
    return constraint.coincident ? std::pair(constraint.coincident->from.body, constraint.coincident->to.body)
                                 : std::pair(constraint.rod->from.body, constraint.rod->to.body);
  }

  /// A ratio is a length per angle, or the other way round, where the coordinates differ.
  void checkGear(const GearSpec& gear) const {
    const std::string unit = findUnit(gear.coordinate), per = findUnit(gear.driver);
    fields_.constants.check(gear.ratio, unit == per ? "1" : unit + "/" + per);
    if (gear.coordinate.text == gear.driver.text) {
      throw ExperimentError(gear.coordinate.where, gear.coordinate.text,
                            "must not drive itself; name another coordinate as 'driver'");
    }
  }

  void checkJoints() const {
    for (const BodySpec& body : model_.system.bodies) {
      if (body.name.text == "ground") {
        throw ExperimentError(body.name.where, "ground", "is the inertial frame; choose another name");
      }
      checkJoint(body.joint, body.name);
      checkInertia(body);
    }
  }

  static void checkJoint(const JointSpec& joint, const Name& body) {
    if (joint.axis && !hasAxis(joint.type)) {
      throw ExperimentError((*joint.axis)[0].where, "", "only " + listJointsWithAxis() + " have an axis");
    }
    const bool has_pitch = !joint.pitch.text.empty();
    if (has_pitch != getTraits(joint.type).has_pitch) {
      throw ExperimentError(has_pitch ? joint.pitch.where : body.where, joint.pitch.text,
                            "a screw needs joint.pitch, other joints have none");
    }
  }

  /// One moment of inertia is about the axis of a joint that has a single one.
  static void checkInertia(const BodySpec& body) {
    const JointType type = body.joint.type;
    const Expression& about_axis = body.inertia.about_axis;
    if (!about_axis.text.empty() && type != JointType::kPin && type != JointType::kPlanar &&
        type != JointType::kCylinder) {
      throw ExperimentError(about_axis.where, about_axis.text,
                            "is about a joint's axis, which pin, planar and cylinder joints have; give "
                            "'moments: [Ixx, Iyy, Izz]' here");
    }
  }

  /// Outputs call joints and forces by their names.
  void checkNames() const {
    std::vector<std::string> joints;
    for (const BodySpec& body : model_.system.bodies) {
      declareOnce(getJointName(body), "a joint", joints);
    }
    std::vector<std::string> forces;
    std::vector<std::string> moved;  // of motions that share a coordinate checkSampled() tells
    for (const NamedForce& force : listNamedForces(model_.system)) {
      if (force.motion < 0 || std::count(moved.begin(), moved.end(), force.name.text) == 0) {
        declareOnce(force.name, "a force element or constraint", forces);
      }
      if (force.motion >= 0) {
        moved.push_back(force.name.text);
      }
    }
    for (const OutputSpec& output : model_.outputs) {
      if (output.reaction) {
        requireKnown(output.reaction->joint, joints, "a joint, or its body");
      }
      if (output.force_of) {
        requireKnown(*output.force_of, forces,
                     "the name of a force element or constraint, or a coordinate whose motion is prescribed");
        checkComponent(output, *findNamedForce(model_.system, output.force_of->text));
      }
    }
  }

  static void declareOnce(const Name& name, const char* what, std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name.text) != names.end()) {
      throw ExperimentError(name.where, name.text,
                            std::string("is the name of another already, and ") + what + " needs its own");
    }
    names.push_back(name.text);
  }

  static void checkComponent(const OutputSpec& output, const NamedForce& force) {
    const ForceParts& parts = force.parts;
    const bool known =
        !output.component ? parts.along : (isMoment(*output.component) ? parts.moment : parts.force);
    if (!known) {
      std::vector<std::string> choices;
      if (parts.along) {
        choices.emplace_back("no component");
      }
      if (parts.force) {
        choices.emplace_back("force_x, force_y or force_z");
      }
      if (parts.moment) {
        choices.emplace_back("moment_x, moment_y or moment_z");
      }
      throw ExperimentError(
          output.force_of->where, output.force_of->text,
          fmt::format("is a {}: give {} in 'component'", force.noun, fmt::join(choices, ", or ")));
    }
  }

  void checkExcitation() {
    for (const SignalSpec& signal : model_.excitation) {
      fields_.own_unit = signal.unit;
      fields_.checkAll(signal);
    }
  }

  void checkInitial() const {
    for (const NamedExpression& initial : model_.initial.coordinates) {
      fields_.constants.check(initial.value, findUnit(initial.name));
    }
    for (const NamedExpression& initial : model_.initial.speeds) {
      fields_.constants.check(initial.value, findUnit(initial.name) + "/s");
    }
    if (model_.initial.equilibrium) {
      for (const NamedExpression& parameter : model_.initial.equilibrium->parameters) {
        requireKnown(parameter.name, collectNames(collectSampled(model_)), "a parameter");
        fields_.constants.check(parameter.value, "");
      }
    }
  }

  /// Outputs also know accelerations.
  void checkOutputs() {
    constexpr double kSomeAcceleration = 0.61;
    const bool any = std::any_of(model_.outputs.begin(), model_.outputs.end(),
                                 [](const OutputSpec& output) { return !output.expression.text.empty(); });
    for (const Coordinate& coordinate : any ? fields_.coordinates : std::vector<Coordinate>{}) {
      fields_.dynamics.define({coordinate.name.text + "_ddot", coordinate.name.where},
                              parseUnit(coordinate.unit + "/s2", {}), kSomeAcceleration);
    }
    for (const OutputSpec& output : model_.outputs) {
      fields_.own_unit = findOutputUnit(output, model_.system);
      fields_.checkAll(output);
    }
  }

  std::string findUnit(const Name& name) const { return fields_.find(name).unit; }

  const ModelSpec& model_;
  FieldCheck fields_;
};

}  // namespace

void checkModel(const ModelSpec& model) {
  ModelCheck(model).run();
}

}  // namespace twinmap
