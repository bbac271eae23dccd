#include <fmt/format.h>

#include <algorithm>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_sampled.hpp"
#include "framework/experiment/check/check_variables.hpp"
#include "framework/experiment/check/field_check.hpp"
#include "framework/experiment/expression/output_units.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior.hpp"

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

void checkPriors(const ModelSpec& model) {
  for (const ParameterSpec& input : model.inputs) {
    if (input.prior) {
      throw ExperimentError(input.name.where, input.name.text,
                            "is a known input, given with each measurement, so that it has no prior");
    }
  }
  Prior(collectUnknown(model), model.priors);
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
    declareDynamics();
    checkJoints();
    fields_.checkAll(model_.system);
    checkPairs();
    checkConstraints();
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

  void declareConstants() {
    for (const ConstantSpec& constant : model_.constants) {
      const double value = fields_.constants.check(constant.value, constant.unit);
      fields_.constants.define(constant.name, CheckScope::readUnit(constant.unit, constant.name.where),
                               value);
    }
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
    declareStates();
    for (const NamedExpression& named : model_.system.expressions) {
      fields_.dynamics.define(named.name, named.value);
    }
  }

  /// <signal>_dot, unless something else has the name.
  void declareSignalRates() {
    constexpr double kSomeRate = 0.83;
    for (const SignalSpec& signal : model_.excitation) {
      const Name rate{signal.name.text + "_dot", signal.name.where};
      const std::vector<std::string>& names = fields_.dynamics.getNames();
      if (std::find(names.begin(), names.end(), rate.text) == names.end()) {
        const std::string unit = makeRateUnit(signal.unit);
        fields_.dynamics.define(rate, unit.empty() ? std::nullopt : std::make_optional(parseUnit(unit, {})),
                                kSomeRate);
      }
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

  /// What slides against each other must move alike.
  void checkPairs() const {
    for (const auto& friction : model_.system.elements.get<Friction>()) {
      if (friction.against && findUnit(*friction.against) != findUnit(friction.coordinate)) {
        throw ExperimentError(friction.against->where, friction.against->text,
                              "is in " + findUnit(*friction.against) + ", but '" + friction.coordinate.text +
                                  "' in " + findUnit(friction.coordinate) +
                                  ": friction acts between two lengths or two angles");
      }
    }
  }

  void checkConstraints() const {
    for (const ConstraintSpec& constraint : model_.system.constraints) {
      if (constraint.gear) {
        checkGear(*constraint.gear);
      } else {
        const bool in_plane = constraint.point_in_plane.has_value();
        const Name& from = in_plane                ? constraint.point_in_plane->plane.station.body
                           : constraint.coincident ? constraint.coincident->from.body
                                                   : constraint.rod->from.body;
        const Name& to = in_plane                ? constraint.point_in_plane->station.body
                         : constraint.coincident ? constraint.coincident->to.body
                                                 : constraint.rod->to.body;
        if (from.text == to.text) {
          throw ExperimentError(to.where, to.text, "must not be constrained against itself; name two bodies");
        }
      }
    }
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
