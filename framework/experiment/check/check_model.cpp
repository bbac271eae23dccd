#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/check/check_scope.hpp"
#include "framework/experiment/expression/output_units.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/parameter_box.hpp"

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
  if (parameter.relative_to == RelativeTo::kValue && bounds.lower <= 0.0 && bounds.upper >= 0.0) {
    throw ExperimentError(
        bounds.where, parameter.name.text,
        "has bounds that contain 0, where a relative error is undefined; give 'relative_to: range'");
  }
}

std::vector<Coordinate> collectCoordinates(const SystemSpec& system) {
  std::vector<Coordinate> coordinates;
  for (const BodySpec& body : system.bodies) {
    const std::vector<JointCoordinate>& expected = getJointCoordinates(body.joint.type);
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

/// Checks every part of the model against the names declared before it.
class ModelCheck {
 public:
  explicit ModelCheck(const ModelSpec& model)
      : model_(model), bodies_{"ground"}, coordinates_(collectCoordinates(model.system)) {}

  void run() {
    declareParameters();
    declareConstants();
    declareDynamics();
    checkBodies();
    checkCoordinateElements();
    checkStationElements();
    checkExcitation();
    checkInitial();
    checkOutputs();
    checkVariables();
  }

 private:
  void declareParameters() {
    for (const ParameterSpec& parameter : collectSampled(model_)) {
      constants_.define(parameter.name, CheckScope::readUnit(parameter.unit, parameter.name.where),
                        0.5 * (parameter.bounds.lower + parameter.bounds.upper));
    }
    for (const ParameterSpec& parameter : model_.parameters) {
      checkRelativeTo(parameter);
    }
  }

  void declareConstants() {
    for (const ConstantSpec& constant : model_.constants) {
      const double value = constants_.check(constant.value, constant.unit);
      constants_.define(constant.name, CheckScope::readUnit(constant.unit, constant.name.where), value);
    }
  }

  /// Force laws also know coordinates, speeds, signals and time. The reference values are arbitrary.
  void declareDynamics() {
    constexpr double kSomeCoordinate = 0.37, kSomeSpeed = 0.53, kSomeSignal = 0.71;
    dynamics_ = constants_;
    for (const Coordinate& coordinate : coordinates_) {
      dynamics_.define(coordinate.name, parseUnit(coordinate.unit, {}), kSomeCoordinate);
      dynamics_.define({coordinate.name.text + "_dot", coordinate.name.where},
                       parseUnit(coordinate.unit + "/s", {}), kSomeSpeed);
    }
    for (const SignalSpec& signal : model_.excitation) {
      dynamics_.define(signal.name, CheckScope::readUnit(signal.unit, signal.name.where), kSomeSignal);
    }
    dynamics_.defineTime();
  }

  void checkBodies() {
    constants_.check(model_.system.gravity, "m/s2");
    for (const BodySpec& body : model_.system.bodies) {
      if (body.name.text == "ground") {
        throw ExperimentError(body.name.where, "ground", "is the inertial frame; choose another name");
      }
      constants_.check(body.mass, "kg");
      constants_.check(body.center_of_mass, "m");
      constants_.check(body.inertia.moments, "kg m2");
      constants_.check(body.inertia.products, "kg m2");
      checkJoint(body.joint, body.name);
      bodies_.push_back(body.name.text);
    }
  }

  void checkJoint(const JointSpec& joint, const Name& body) const {
    requireKnown(joint.parent, bodies_, "ground or a body declared before");
    if (joint.axis && !hasAxis(joint.type)) {
      throw ExperimentError((*joint.axis)[0].where, "", "only slider, pin, screw and cylinder have an axis");
    }
    if (joint.axis) {
      constants_.check(*joint.axis, "");
    }
    const bool has_pitch = !joint.pitch.text.empty();
    if (has_pitch != (joint.type == JointType::kScrew)) {
      throw ExperimentError(has_pitch ? joint.pitch.where : body.where, joint.pitch.text,
                            "a screw needs joint.pitch, other joints have none");
    }
    if (has_pitch) {
      constants_.check(joint.pitch, "m/rad");
    }
    checkFrame(joint.in_parent);
    checkFrame(joint.in_body);
  }

  void checkFrame(const FrameSpec& frame) const {
    constants_.check(frame.point, "m");
    constants_.check(frame.orientation, "rad");
  }

  void checkCoordinateElements() const {
    for (const SpringSpec& spring : model_.system.springs) {
      const std::string unit = findForcedUnit(spring.coordinate);
      constants_.check(spring.stiffness, unit == "m" ? "N/m" : "N m/rad");
      constants_.check(spring.rest, unit);
    }
    for (const DamperSpec& damper : model_.system.dampers) {
      constants_.check(damper.damping, findForcedUnit(damper.coordinate) == "m" ? "N s/m" : "N m s/rad");
    }
    for (const ForceLawSpec& law : model_.system.force_laws) {
      dynamics_.check(law.force, findForcedUnit(law.coordinate) == "m" ? "N" : "N m");
    }
  }

  void checkStationElements() const {
    for (const TwoPointSpringSpec& spring : model_.system.two_point_springs) {
      checkStation(spring.from);
      checkStation(spring.to);
      constants_.check(spring.stiffness, "N/m");
      constants_.check(spring.rest_length, "m");
    }
    for (const TwoPointDamperSpec& damper : model_.system.two_point_dampers) {
      checkStation(damper.from);
      checkStation(damper.to);
      constants_.check(damper.damping, "N s/m");
    }
    for (const BushingSpec& bushing : model_.system.bushings) {
      checkBushing(bushing);
    }
    for (const AppliedForceSpec& force : model_.system.applied_forces) {
      checkStation(force.station);
      dynamics_.check(force.force, "N");
    }
    for (const AppliedMomentSpec& moment : model_.system.applied_moments) {
      requireKnown(moment.body, bodies_, "a body or ground");
      dynamics_.check(moment.moment, "N m");
    }
  }

  void checkBushing(const BushingSpec& bushing) const {
    for (const BodyFrameSpec* end : {&bushing.from, &bushing.to}) {
      requireKnown(end->body, bodies_, "a body or ground");
      checkFrame(end->frame);
    }
    constexpr std::size_t kRotations = 3;
    for (std::size_t i = 0; i < bushing.stiffness.size(); ++i) {
      constants_.check(bushing.stiffness[i], i < kRotations ? "N m/rad" : "N/m");
      constants_.check(bushing.damping[i], i < kRotations ? "N m s/rad" : "N s/m");
    }
  }

  void checkStation(const StationSpec& station) const {
    requireKnown(station.body, bodies_, "a body or ground");
    constants_.check(station.point, "m");
  }

  void checkExcitation() const {
    for (const SignalSpec& signal : model_.excitation) {
      for (const PulseSpec& pulse : signal.pulses) {
        checkTerm(pulse.amplitude, signal.unit, {&pulse.start, &pulse.end});
      }
      for (const SineSpec& sine : signal.sines) {
        checkTerm(sine.amplitude, signal.unit, {&sine.start, &sine.end});
        constants_.check(sine.frequency, "Hz");
        constants_.check(sine.phase, "rad");
      }
      for (const ChirpSpec& chirp : signal.chirps) {
        checkTerm(chirp.amplitude, signal.unit, {&chirp.start, &chirp.end});
        constants_.check(chirp.start_frequency, "Hz");
        constants_.check(chirp.end_frequency, "Hz");
      }
      for (const MultisineSpec& multisine : signal.multisines) {
        checkAll(listAmplitudes(multisine), signal.unit);
        checkTimes({&multisine.start, &multisine.end});
        checkAll(multisine.frequencies, "Hz");
        checkAll(multisine.phases, "rad");
      }
    }
  }

  void checkTerm(const Expression& amplitude, const std::string& unit,
                 std::initializer_list<const Expression*> times) const {
    constants_.check(amplitude, unit);
    checkTimes(times);
  }

  static std::vector<Expression> listAmplitudes(const MultisineSpec& multisine) {
    return multisine.amplitudes.empty() ? std::vector<Expression>{multisine.amplitude} : multisine.amplitudes;
  }

  void checkTimes(std::initializer_list<const Expression*> times) const {
    for (const Expression* time : times) {
      if (!time->text.empty()) {
        constants_.check(*time, "s");
      }
    }
  }

  void checkAll(const std::vector<Expression>& expressions, const std::string& unit) const {
    for (const Expression& expression : expressions) {
      constants_.check(expression, unit);
    }
  }

  void checkInitial() const {
    for (const NamedExpression& initial : model_.initial.coordinates) {
      constants_.check(initial.value, findUnit(initial.name));
    }
    for (const NamedExpression& initial : model_.initial.speeds) {
      constants_.check(initial.value, findUnit(initial.name) + "/s");
    }
    if (model_.initial.equilibrium) {
      for (const NamedExpression& parameter : model_.initial.equilibrium->parameters) {
        requireKnown(parameter.name, collectNames(collectSampled(model_)), "a parameter");
        constants_.check(parameter.value, "");
      }
    }
  }

  void checkOutputs() const {
    for (const OutputSpec& output : model_.outputs) {
      for (const std::optional<Name>& coordinate : {output.coordinate, output.speed}) {
        if (coordinate) {
          findUnit(*coordinate);
        }
      }
      for (const auto& station_output : {output.position, output.velocity, output.acceleration}) {
        if (station_output) {
          checkStation(station_output->station);
          constants_.check(station_output->direction, "");
        }
      }
      checkSensor(output);
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
      if (!elsewhere && !output.unit.empty()) {
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

  void checkSensor(const OutputSpec& output) const {
    if (!output.gain.text.empty()) {
      constants_.check(output.gain, "1");
    }
    if (!output.offset.text.empty()) {
      constants_.check(output.offset, findOutputUnit(output, model_.system));
    }
  }

  const Coordinate& find(const Name& name) const {
    std::vector<std::string> names;
    for (const Coordinate& coordinate : coordinates_) {
      if (coordinate.name.text == name.text) {
        return coordinate;
      }
      names.push_back(coordinate.name.text);
    }
    requireKnown(name, names, "a coordinate");
    throw std::logic_error("a coordinate is known by name, but not listed");
  }

  std::string findUnit(const Name& name) const { return find(name).unit; }

  /// The unit of a coordinate on which a force acts.
  std::string findForcedUnit(const Name& name) const {
    const Coordinate& coordinate = find(name);
    if (!coordinate.takes_forces) {
      throw ExperimentError(
          name.where, name.text,
          "is an angle of a ball or free joint, whose speeds are an angular velocity; use a "
          "bushing or an applied moment instead");
    }
    return coordinate.unit;
  }

  const ModelSpec& model_;
  std::vector<std::string> bodies_;
  std::vector<Coordinate> coordinates_;
  CheckScope constants_;
  CheckScope dynamics_;
};

}  // namespace

void checkModel(const ModelSpec& model) {
  ModelCheck(model).run();
}

}  // namespace twinmap
