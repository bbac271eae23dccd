#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_sampled.hpp"
#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/expression/expression_tree.hpp"
#include "framework/experiment/expression/output_units.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {
namespace {

/// A coordinate of the system, its unit, and whether forces may act on it directly.
struct Coordinate {
  Name name;
  std::string unit;
  bool takes_forces;
};

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

std::vector<Coordinate> collectCoordinates(const SystemSpec& system) {
  std::vector<Coordinate> coordinates;
  for (const BodySpec& body : system.bodies) {
    const JointCoordinates& expected = getJointCoordinates(body.joint.type);
    if (body.joint.coordinates.size() != expected.size()) {
      throw ExperimentError(
          body.name.where, body.name.text,
          fmt::format("has {} names in joint.coordinates, but its type of joint has {} coordinates",
                      body.joint.coordinates.size(), expected.size()));
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      coordinates.push_back({body.joint.coordinates[i], getUnit(expected[i].kind), expected[i].takes_forces});
    }
  }
  return coordinates;
}

/// "" for "".
std::string makeRateUnit(const std::string& unit) {
  return unit.empty() ? "" : unit == "-" ? "1/s" : "(" + unit + ")/s";
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

/// Checks the fields of descriptions (fields/fields.hpp) against the names declared before: expressions know
/// their names and come out in their units, names refer to something.
class FieldCheck {
 public:
  std::vector<std::string> bodies{"ground"};
  std::vector<Coordinate> coordinates;
  CheckScope constants;  ///< parameters and constants
  CheckScope dynamics;   ///< with coordinates, speeds, signals and time
  std::string own_unit;  ///< what kOwnUnit stands for

  template <class T, class... Rule>
  void required(const char*, const T& field, const char*, const Rule&... rule) {
    check(field, rule...);
  }
  template <class T, class... Rule>
  void optional(const char*, const T& field, const char*, const Rule&... rule) {
    check(field, rule...);
  }
  template <class T>
  void requiredMap(const char*, const std::vector<T>& fields, const char*) {
    for (const T& field : fields) {
      check(field);
      declare(field);
    }
  }
  /// States, and named expressions, which are checked where they are declared.
  void optionalMap(const char*, const std::vector<StateSpec>& states, const char*) {
    for (const StateSpec& state : states) {
      constants.check(state.initial, state.unit);
      dynamics.check(state.derivative, makeRateUnit(state.unit));
    }
  }
  void optionalMap(const char*, const std::vector<NamedExpression>&, const char*) {}
  /// checkSampled() does.
  void optionalMap(const char*, const std::vector<ControllerSpec>&, const char*) {}
  template <class... Choices>
  void oneOf(const char*, Choices... choices) {
    (std::apply([&](const auto&... rule) { check(std::as_const(choices.value), rule...); }, choices.rules),
     ...);
  }
  void rule(bool, const char*) const {}
  void location(const SourceLocation&) const {}

  /// All fields of a struct, which are read only.
  template <class T>
  void checkAll(const T& described) {
    describe(*this, const_cast<T&>(described));
  }

  const Coordinate& find(const Name& name) const {
    std::vector<std::string> names;
    for (const Coordinate& coordinate : coordinates) {
      if (coordinate.name.text == name.text) {
        return coordinate;
      }
      names.push_back(coordinate.name.text);
    }
    requireKnown(name, names, "a coordinate");
    throw std::logic_error("a coordinate is known by name, but not listed");
  }

 private:
  void check(const Bounds&) {}
  void check(const Expression& expression, const Unit& unit) { check(expression, unit, on_angle_); }
  void check(const Expression& expression, const Unit& unit, bool on_angle) {
    if (!expression.text.empty()) {
      const CheckScope& scope = unit.varies ? dynamics : constants;
      scope.check(expression, unit.own ? own_unit : makeUnit(unit, on_angle));
    }
  }
  static std::string makeUnit(const Unit& unit, bool on_angle) {
    const std::string text = on_angle && unit.rotation != nullptr ? unit.rotation : unit.text;
    return unit.power == 1.0 ? text : std::isnan(unit.power) ? "" : text + "^" + toText(unit.power);
  }
  void check(const SixOf<Expression>& expressions, const Unit& unit) {
    constexpr std::size_t kRotations = 3;
    for (std::size_t i = 0; i < expressions.size(); ++i) {
      check(expressions[i], unit, i < kRotations);
    }
  }
  void check(const Name& name, Reference reference) {
    switch (reference) {
      case Reference::kBody:
        return requireKnown(name, bodies, "a body or ground");
      case Reference::kEarlierBody:
        return requireKnown(name, bodies, "ground or a body declared before");
      case Reference::kForcedCoordinate:
        requireForced(find(name), name);
        [[fallthrough]];
      case Reference::kCoordinate:
        on_angle_ = find(name).unit != "m";
    }
  }
  template <class T, std::size_t N>
  void check(const std::array<T, N>& fields, const Unit& unit) {
    for (const T& field : fields) {
      check(field, unit);
    }
  }
  template <class T, class... Rule>
  void check(const std::vector<T>& fields, const Rule&... rule) {
    for (const T& field : fields) {
      check(field, rule...);
    }
  }
  void check(const std::vector<Expression>& fields, const ListRule&, const Unit& unit) {
    check(fields, unit);
  }
  template <class T, class... Rule>
  void check(const std::optional<T>& field, const Rule&... rule) {
    if (field) {
      check(*field, rule...);
    }
  }
  /// What has no unit and refers to nothing, or a struct.
  template <class T, class... Rule>
  void check(const T& field, const Rule&...) {
    if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> && !std::is_same_v<T, Name>) {
      checkAll(field);
    }
  }

  void declare(const BodySpec& body) { bodies.push_back(body.name.text); }

  static void requireForced(const Coordinate& coordinate, const Name& name) {
    if (!coordinate.takes_forces) {
      throw ExperimentError(
          name.where, name.text,
          "is an angle of a ball or free joint, whose speeds are an angular velocity; use a "
          "bushing or an applied moment instead");
    }
  }

  bool on_angle_ = false;  ///< whether the coordinate that was referred to last is an angle
};

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
    checkVariables();
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

  void checkSourceFiles(const SourceSpec& source) const {
    std::error_code ignored;
    if (source.fmu && !std::filesystem::is_regular_file(source.fmu->file.text, ignored)) {
      throw ExperimentError(source.fmu->file.where, source.fmu->file.text, "is not a file");
    }
    if (!source.program) {
      return;
    }
    const std::filesystem::path folder = source.program->working_folder;
    const SourceLocation where{model_.parameters.front().name.where.file, 0, 0, "model.program"};
    if (!std::filesystem::is_directory(folder, ignored)) {
      throw ExperimentError(where, folder.string(), "is not a folder");
    }
    for (const std::string& file : source.program->depends_on) {
      if (!std::filesystem::is_regular_file(folder / file, ignored)) {
        throw ExperimentError(where, file, "is not a file that it could depend on");
      }
    }
  }

  /// Variables are those of a model from elsewhere, which has no coordinates.
  void checkVariables() const {
    const bool elsewhere = model_.source.has_value();
    for (const OutputSpec& output : model_.outputs) {
      if (output.variable.has_value() != elsewhere) {
        throw ExperimentError(output.name.where, output.name.text,
                              elsewhere ? "must give the variable of the model that it is"
                                        : "is a variable, which only an FMU or a program has");
      }
      if (!elsewhere && output.expression.text.empty() && !output.unit.empty()) {
        throw ExperimentError(output.name.where, output.name.text,
                              "has the unit of what it measures; state none");
      }
      CheckScope::readUnit(output.unit, output.name.where);
    }
    const auto refuse = [&](const auto& items) {
      for (const auto& item : items) {
        if (item.variable && !elsewhere) {
          throw ExperimentError(item.variable->where, item.variable->text,
                                "is a variable, which only an FMU or a program has");
        }
      }
    };
    refuse(collectSampled(model_));
    refuse(model_.constants);
    refuse(model_.excitation);
    if (elsewhere) {
      checkSourceFiles(*model_.source);
    }
    const InitialSpec& initial = model_.initial;
    if (elsewhere && (!initial.coordinates.empty() || !initial.speeds.empty() || initial.equilibrium)) {
      throw ExperimentError(
          {model_.parameters.front().name.where.file, 0, 0, "initial"}, "",
          "is for a system; set the start values of a model from elsewhere by constants with a variable");
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
