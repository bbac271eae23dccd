#include "framework/multibody/multibody_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "framework/multibody/lanes/compare_with_simbody.hpp"
#include "framework/multibody/lanes/lane_runner.hpp"
#include "framework/multibody/linearization.hpp"
#include "framework/multibody/run_sample.hpp"
#include "framework/spec/check/check_experiment.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {
namespace {

/// Systems and expressions are built one at a time: Simbody and muParser do not say that they may be
/// otherwise.
std::mutex building;

/// What all clones share.
struct SharedModel {
  SharedModel(ModelSpec of, ResponseLayout rows) : model(std::move(of)), layout(std::move(rows)) {}

  ModelSpec model;
  ResponseLayout layout;
  Eigen::VectorXd box_center;  ///< coordinates of the equilibrium there, if the spec asks for it
  std::string engine = "simbody";
  std::optional<LaneModel> lanes;             ///< if they are the engine
  std::optional<LaneModel> lane_derivatives;  ///< made when first used
  std::mutex making_precise{};
  std::unique_ptr<MultibodySimulator> precise{};  ///< made when first used
};

/// Samples handed out at once: enough to keep all lanes busy but at the end, few enough to share work.
constexpr int kLaneBatch = 128;

void checkTimes(const Eigen::VectorXd& times, double duration) {
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const bool inside = times[i] >= 0.0 && times[i] <= duration;
    if (!inside || (i > 0 && times[i] <= times[i - 1])) {
      throw ExperimentError("sample time " + std::to_string(times[i]) +
                            " s must lie within the simulation's duration and after the one before");
    }
  }
}

void checkSimulation(const SimulationSpec& simulation) {
  if (!(simulation.duration > 0.0) || !std::isfinite(simulation.duration)) {
    throw ExperimentError("simulation.duration must be positive");
  }
  if (!(simulation.relative_tolerance > 0.0) || !(simulation.absolute_tolerance > 0.0)) {
    throw ExperimentError("simulation.relative_tolerance and absolute_tolerance must be positive");
  }
}

void checkShapes(const SharedModel& shared, const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                 const Eigen::Ref<Eigen::MatrixXd>& responses) {
  if (parameters.rows() != countSampled(shared.model) || responses.rows() != shared.layout.getRowCount() ||
      responses.cols() != parameters.cols()) {
    throw std::invalid_argument("MultibodySimulator::simulate: a matrix has the wrong shape");
  }
}

int findParameter(const ModelSpec& model, const Name& name) {
  const std::vector<std::string> names = collectNames(collectSampled(model));
  requireKnown(name, names, "a parameter");
  return static_cast<int>(std::find(names.begin(), names.end(), name.text) - names.begin());
}

/// The box centre with the values that replace it; those may use the centre's parameters and constants.
Eigen::VectorXd calcEquilibriumPoint(ModelContext& context) {
  Eigen::VectorXd point = calcBoxCenter(collectSampled(context.model));
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  if (equilibrium) {
    for (const NamedExpression& value : equilibrium->parameters) {
      const std::string owner = "initial.equilibrium";
      point[findParameter(context.model, value.name)] =
          context.numbers.updNumbers().calc(value.value, {owner, value.name.text.c_str(), ""});
    }
  }
  return point;
}

/// Builds everything at the box centre, so that all expressions are compiled and all names are known.
void buildAtBoxCenter(ModelContext& context) {
  const LoadedSystem system(context, false);
  const Outputs outputs(context.model.outputs, context.names, context.numbers.updNumbers());
  calcInitialValues(context);
}

/// Why the model cannot be simulated in lanes whatever its equations are, or "".
std::string findObstacle(const ModelContext& context) {
  if (context.model.simulation.engine == Engine::kSimbody) {
    return "simulation.engine asks for it";
  }
  if (context.model.simulation.integrator != Integrator::kDopri5) {
    return "simulation.integrator is one of Simbody's";
  }
  return context.names.getCoordinateNames().empty() ? "nothing can move" : "";
}

/// Compiles the model for lanes if it can be; returns why not, or "".
std::string makeLanes(ModelContext& context, const Eigen::VectorXd& box_center,
                      std::optional<LaneModel>& lanes) {
  const std::string obstacle = findObstacle(context);
  if (!obstacle.empty()) {
    return obstacle;
  }
  try {
    lanes = compileModel(recordModel(context.model, context.names, box_center), false);
  } catch (const UnknownSyntax& error) {
    return error.what();
  }
  const std::string difference = compareWithSimbody(context, *lanes);
  if (!difference.empty()) {
    lanes.reset();
  }
  return difference;
}

Eigen::VectorXd solveBoxCenter(ModelContext& context) {
  context.numbers.update(calcEquilibriumPoint(context));
  LoadedSystem system(context, false);
  return solveEquilibrium(system, calcInitialValues(context).coordinates);
}

/// The initial state at the current point exists and its accelerations are finite; else SimulationFailure.
void checkInitialState(ModelContext& context, const Eigen::VectorXd& box_center) {
  LoadedSystem system(context, false);
  SimTK::State state = system.getTree().getDefaultState();
  setState(system, calcInitialState(context, system, box_center), state);
  context.excitation.beginPhase(0.0);
  const bool finite = system.calcUDot(state, 0.0).allFinite();
  context.excitation.mute();
  if (!finite) {
    throw SimulationFailure("the accelerations of the initial state are not finite");
  }
}

/// What is wrong with the model at the centre of its box, with the number that is the cause, or `system`.
ExperimentError makeCenterError(const ModelSpec& model, SourceLocation where, const std::string& reason) {
  if (where.file.empty() && !model.system.bodies.empty()) {
    where = model.system.bodies.front().name.where;
    where.key_path = where.file.empty() ? "" : "system";
  }
  const std::string place = toString(where);
  return ExperimentError((place.empty() ? "" : place + ": ") +
                         "at the centre of the parameter box: " + reason);
}

}  // namespace

class MultibodySimulator::Impl {
 public:
  Impl(const ModelSpec& model, Eigen::VectorXd times, int modes)
      : Impl(std::make_shared<SharedModel>(model, ResponseLayout{{}, {}, std::move(times), modes})) {}

  explicit Impl(std::shared_ptr<SharedModel> shared) : shared_(std::move(shared)), context_(shared_->model) {}

  /// Compiles all expressions now, while clones are made one after the other.
  void compileAll() {
    context_.numbers.update(calcBoxCenter(collectSampled(shared_->model)));
    buildAtBoxCenter(context_);
  }

  /// Completes what the clones share.
  void prepare() {
    if (shared_->layout.times.size() > 0) {
      checkSimulation(shared_->model.simulation);
    }
    checkTimes(shared_->layout.times, shared_->model.simulation.duration);
    shared_->layout.output_units = twinmap::getOutputUnits(shared_->model.outputs, context_.names);
    for (const OutputSpec& output : shared_->model.outputs) {
      shared_->layout.output_names.push_back(output.name.text);
    }
    atBoxCenter([this] {
      compileAll();
      const std::optional<EquilibriumSpec>& equilibrium = shared_->model.initial.equilibrium;
      if (equilibrium && equilibrium->at == EquilibriumAt::kBoxCenter) {
        shared_->box_center = solveBoxCenter(context_);
      }
    });
    chooseEngine();
  }

  void checkStart() {
    atBoxCenter([this] {
      context_.numbers.update(calcBoxCenter(collectSampled(shared_->model)));
      checkInitialState(context_, shared_->box_center);
    });
  }

  /// All columns, in lanes or one after the other.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) {
    if (shared_->lanes) {
      simulateInLanes(parameters, responses, statuses);
      return;
    }
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      StepSequence own_steps;
      statuses[i] = simulateOne(parameters.col(i), responses.col(i), own_steps);
    }
  }

  void simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               Eigen::Ref<Eigen::MatrixXd> responses, Eigen::MatrixXd& derivatives,
                               SampleStatus* statuses) {
    if (!derivative_runner_) {
      derivative_runner_.emplace(getLaneDerivatives(), LaneTask{shared_->layout, shared_->box_center},
                                 shared_->model);
    }
    derivative_runner_->run(context_, parameters, responses, &derivatives, statuses);
  }

  /// By Simbody. Takes the steps of `sequence` if there are any, else keeps there those it took.
  SampleStatus simulateOne(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                           Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
    return simulateOne(shared_->model.simulation, parameters, response, sequence);
  }

  const std::shared_ptr<SharedModel>& getShared() const { return shared_; }

 private:
  void chooseEngine() {
    const std::string obstacle = makeLanes(context_, shared_->box_center, shared_->lanes);
    if (!obstacle.empty() && shared_->model.simulation.engine == Engine::kLanes) {
      throw ExperimentError("simulation.engine: lanes cannot simulate this model: " + obstacle);
    }
    shared_->engine = obstacle.empty() ? "lanes" : "simbody: " + obstacle;
  }

  void simulateInLanes(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                       Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
    if (!runner_) {
      runner_.emplace(*shared_->lanes, LaneTask{shared_->layout, shared_->box_center}, shared_->model);
    }
    for (const Eigen::Index i : runner_->run(context_, parameters, responses, nullptr, statuses)) {
      tryImplicitly(parameters.col(i), responses.col(i), statuses[i]);
    }
  }

  const LaneModel& getLaneDerivatives() {
    const std::lock_guard<std::mutex> guard(building);
    if (!shared_->lane_derivatives) {
      shared_->lane_derivatives =
          compileModel(recordModel(shared_->model, context_.names, shared_->box_center), true);
    }
    return *shared_->lane_derivatives;
  }

  /// What reached the step limit may be stiff: CPodes tries it once more.
  void tryImplicitly(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                     Eigen::Ref<Eigen::VectorXd> response, SampleStatus& status) {
    SimulationSpec simulation = shared_->model.simulation;
    simulation.integrator = Integrator::kCpodes;
    StepSequence unused;
    SampleStatus again = simulateOne(simulation, parameters, response, unused);
    again.second_try = true;
    if (!again.ok) {
      again.reason = status.reason + "; by CPodes: " + again.reason;
    }
    status = again;
  }

  SampleStatus simulateOne(const SimulationSpec& simulation,
                           const Eigen::Ref<const Eigen::VectorXd>& parameters,
                           Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
    SampleStatus status;
    try {
      status.reason = run(simulation, parameters, response, sequence);
      if (status.reason.empty() && !response.allFinite()) {
        status.reason = "an output became non-finite";
      }
    } catch (const WallTimeReached& failure) {
      status.reason = failure.what();
      status.machine_dependent = true;
    } catch (const SimulationFailure& failure) {
      status.reason = failure.what();
    } catch (const SimTK::Exception::Base& error) {
      status.reason = std::string("Simbody: ") + error.getMessage();
    }
    status.ok = status.reason.empty();
    if (!status.ok) {
      response.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    return status;
  }

  /// What fails in `build` is wrong input.
  template <typename Build>
  void atBoxCenter(const Build& build) const {
    try {
      build();
    } catch (const SimulationFailure& failure) {
      throw makeCenterError(shared_->model, failure.getWhere(), failure.what());
    } catch (const SimTK::Exception::Base& error) {
      std::string message = error.getMessage();
      std::replace(message.begin(), message.end(), '\n', ' ');
      throw makeCenterError(shared_->model, {}, "Simbody: " + message);
    }
  }

  std::string run(const SimulationSpec& simulation, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                  Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
    const bool own = simulation.integrator == Integrator::kDopri5;
    context_.numbers.update(parameters);
    LoadedSystem system(context_, !own);
    fillModes(system, response);  // before the integration, which switches the excitation on
    if (shared_->layout.times.size() == 0) {
      return "";
    }
    const Outputs outputs(shared_->model.outputs, context_.names, context_.numbers.updNumbers());
    const InitialState initial = calcInitialState(context_, system, shared_->box_center);
    const SampleRun sample{system,     context_.excitation,   outputs,        initial,
                           simulation, shared_->layout.times, response.data()};
    return own ? runDopri5(sample, sequence) : runSimbody(sample);
  }

  void fillModes(LoadedSystem& system, Eigen::Ref<Eigen::VectorXd> response) {
    const ResponseLayout& layout = shared_->layout;
    if (layout.modes == 0) {
      return;
    }
    const Eigen::VectorXd start =
        shared_->box_center.size() > 0 ? shared_->box_center : calcInitialValues(context_).coordinates;
    response.tail(2 * layout.modes) =
        collectLowestModes(calcStateMatrix(system, solveEquilibrium(system, start)), layout.modes);
  }

  std::shared_ptr<SharedModel> shared_;
  ModelContext context_;
  std::optional<LaneRunner> runner_, derivative_runner_;
};

MultibodySimulator::MultibodySimulator(const ModelSpec& model, Eigen::VectorXd times, int modes) {
  const std::lock_guard<std::mutex> guard(building);
  impl_ = std::make_unique<Impl>(model, std::move(times), modes);
  impl_->prepare();
}

MultibodySimulator::MultibodySimulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MultibodySimulator::~MultibodySimulator() = default;

const ResponseLayout& MultibodySimulator::getLayout() const {
  return impl_->getShared()->layout;
}

void MultibodySimulator::checkStart() {
  const std::lock_guard<std::mutex> guard(building);
  impl_->checkStart();
}

const std::string& MultibodySimulator::getEngine() const {
  return impl_->getShared()->engine;
}

int MultibodySimulator::getBatchSize() const {
  return impl_->getShared()->lanes ? kLaneBatch : 1;
}

void MultibodySimulator::simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                  Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), parameters, responses);
  impl_->simulate(parameters, responses, statuses);
}

void MultibodySimulator::simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                        Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), parameters, responses);
  StepSequence steps_of_center;
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    statuses[i] = impl_->simulateOne(parameters.col(i), responses.col(i), steps_of_center);
  }
}

bool MultibodySimulator::hasDerivatives() const {
  return impl_->getShared()->lanes.has_value();
}

void MultibodySimulator::simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                                 Eigen::Ref<Eigen::MatrixXd> responses,
                                                 Eigen::MatrixXd& derivatives, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), parameters, responses);
  impl_->simulateWithDerivatives(parameters, responses, derivatives, statuses);
}

std::unique_ptr<Simulator> MultibodySimulator::clonePrecisely() const {
  constexpr double kShare = 0.01, kLeastRelative = 1e-13, kLeastAbsolute = 1e-18;
  SharedModel& shared = *impl_->getShared();
  const std::lock_guard<std::mutex> guard(shared.making_precise);
  if (!shared.precise) {
    ModelSpec model = shared.model;
    SimulationSpec& simulation = model.simulation;
    simulation.relative_tolerance = std::max(kShare * simulation.relative_tolerance, kLeastRelative);
    simulation.absolute_tolerance = std::max(kShare * simulation.absolute_tolerance, kLeastAbsolute);
    shared.precise = std::make_unique<MultibodySimulator>(model, shared.layout.times, shared.layout.modes);
  }
  return shared.precise->clone();
}

std::unique_ptr<Simulator> MultibodySimulator::clone() const {
  const std::lock_guard<std::mutex> guard(building);
  auto impl = std::make_unique<Impl>(impl_->getShared());
  impl->compileAll();
  return std::unique_ptr<Simulator>(new MultibodySimulator(std::move(impl)));
}

}  // namespace twinmap
