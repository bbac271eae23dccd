#include "framework/models/mechanism/simulator/multibody_simulator.hpp"

#include <fmt/core.h>

#include <cmath>
#include <mutex>
#include <stdexcept>

#include "framework/experiment/model/jumps.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/lanes/lane_engine.hpp"
#include "framework/models/mechanism/lanes/recording/delay_reach.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"
#include "framework/models/mechanism/simbody_model.hpp"
#include "framework/models/mechanism/simulator/describe_model.hpp"
#include "framework/models/mechanism/system_numbers.hpp"

namespace twinmap {
namespace {

/// Systems are built one at a time: Simbody does not say that they may be otherwise.
std::recursive_mutex building;

/// What all clones share.
struct SharedModel {
  SharedModel(ModelSpec of, ResponseLayout rows, ModelCheck how)
      : model(addControllerStates(std::move(of))),
        known_to_simbody(removeSampled(model)),
        layout(std::move(rows)),
        check(how) {}

  ModelSpec model, known_to_simbody;
  ResponseLayout layout;
  ModelCheck check;
  Eigen::VectorXd box_center;           ///< coordinates of the equilibrium that all start from
  std::unique_ptr<LanePrograms> lanes;  ///< null where Simbody simulates
  std::string engine;
  std::vector<std::string> jumps;  ///< listJumps()
  std::mutex making_precise{};
  std::unique_ptr<MultibodySimulator> precise{};  ///< made when first used
};

#if defined(__AVX2__) && defined(__FMA__) && !defined(__AVX512F__)
constexpr bool kHasCommonVectors = true;  ///< those of x86-64-v3
#else
constexpr bool kHasCommonVectors = false;
#endif

/// Samples handed out at once: enough to keep all lanes busy but at the end, few enough to share work.
constexpr int kLaneBatch = 128;

void checkSimulation(const SimulationSpec& simulation) {
  if (!(simulation.duration > 0.0) || !std::isfinite(simulation.duration)) {
    throw ExperimentError("simulation.duration must be positive");
  }
  if (!(simulation.relative_tolerance > 0.0) || !(simulation.absolute_tolerance > 0.0)) {
    throw ExperimentError("simulation.relative_tolerance and absolute_tolerance must be positive");
  }
}

void checkShapes(const SharedModel& shared, const ResponseLayout& layout,
                 const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                 const Eigen::Ref<Eigen::MatrixXd>& responses) {
  if (parameters.rows() != countSampled(shared.model) || responses.rows() != layout.getRowCount() ||
      responses.cols() != parameters.cols()) {
    throw std::invalid_argument("MultibodySimulator::simulate: a matrix has the wrong shape");
  }
}

/// Names the force that made the steps so small that their limit was reached.
void explainStepLimits(const std::vector<std::string>& jumps, Eigen::Index count, SampleStatus* statuses) {
  for (Eigen::Index i = 0; i < count && !jumps.empty(); ++i) {
    if (!statuses[i].ok && statuses[i].reason.rfind("step limit", 0) == 0) {
      statuses[i].reason += "; " + jumps.front();
    }
  }
}

/// Equations in lanes have the same bits in every build and width; what else determines a response is
/// compiled for a processor.
void requirePortable(const SharedModel& shared, const std::string& obstacle) {
  const std::string what = !obstacle.empty() ? "Simbody simulates this model (" + obstacle + ")"
                           : shared.model.initial.equilibrium ? "an equilibrium is solved for"
                           : shared.layout.modes > 0          ? "modes are solved for"
                                                              : "";
  if (!what.empty()) {
    throw ExperimentError(
        "simulation.portable: true cannot be held by a program that was built for vectors of one "
        "processor, since " +
        what + "; use the portable build (x86-64-v3)");
  }
}

/// Throws where lanes are asked for and cannot simulate the model. `simbody`: to compare with, or null.
void chooseEngine(ModelContext& context, SimbodyModel* simbody, SharedModel& shared) {
  auto lanes = std::make_unique<LanePrograms>(context, simbody);
  const std::string& obstacle = lanes->getObstacle();
  if (!obstacle.empty() && shared.model.simulation.engine == Engine::kLanes) {
    throw ExperimentError("simulation.engine: lanes cannot simulate this model: " + obstacle);
  }
  if (const std::string key = findSampledKey(shared.model); !obstacle.empty() && !key.empty()) {
    throw ExperimentError(key + " is simulated in lanes only, which cannot simulate this model: " + obstacle);
  }
  if (shared.model.simulation.portable && !kHasCommonVectors) {
    requirePortable(shared, obstacle);
  }
  shared.engine = obstacle.empty() ? "lanes" : "simbody: " + obstacle;
  if (obstacle.empty()) {
    shared.lanes = std::move(lanes);
  }
}

}  // namespace

class MultibodySimulator::Impl {
 public:
  /// The first of the clones: completes what they share.
  Impl(const ModelSpec& model, Eigen::VectorXd times, int modes, ModelCheck check)
      : shared_(std::make_shared<SharedModel>(model, ResponseLayout{{}, {}, std::move(times), modes}, check)),
        context_(shared_->model) {
    if (shared_->layout.times.size() > 0) {
      checkSimulation(shared_->model.simulation);
    }
    checkSampleTimes(shared_->layout.times, shared_->model.simulation.duration);
    requireWithinSimulation(shared_->model, shared_->layout.times);
    shared_->layout.output_units = twinmap::getOutputUnits(shared_->model.outputs, context_.names);
    for (const OutputSpec& output : shared_->model.outputs) {
      shared_->layout.output_names.push_back(output.name.text);
    }
    shared_->jumps = listJumps(shared_->model.system);
    chooseEngine(context_, check == ModelCheck::kBySimbody ? &updSimbody() : nullptr, *shared_);
    const SystemSpec& system = shared_->model.system;
    const bool in_lanes =
        check == ModelCheck::kTrusted || !system.motions.empty() || !system.controllers.empty();
    shared_->box_center = in_lanes && shared_->lanes ? solveBoxCenter(context_, shared_->lanes->getValues())
                                                     : updSimbody().solveBoxCenter();
    layout_ = shared_->layout;
    makeLanes();
  }

  /// Compiles all expressions now, while clones are made one after the other.
  Impl(std::shared_ptr<SharedModel> shared, ResponseLayout layout)
      : shared_(std::move(shared)), layout_(std::move(layout)), context_(shared_->model) {
    makeLanes();
    if (!lanes_) {
      updSimbody();
    }
  }

  void checkStart() { updSimbody().checkStart(shared_->box_center); }

  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses) {
    if (lanes_) {
      lanes_->simulate(parameters, responses, statuses);
      return;
    }
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      StepSequence own_steps;
      statuses[i] = simulateBySimbody(parameters.col(i), responses.col(i), own_steps);
    }
  }

  void simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                      Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
    StepSequence steps_of_center;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      statuses[i] = simulateBySimbody(parameters.col(i), responses.col(i), steps_of_center);
    }
  }

  std::vector<std::string> describeModel() {
    return twinmap::describeModel(context_, shared_->lanes ? &shared_->lanes->getValues() : nullptr,
                                  shared_->box_center);
  }

  LaneEngine& updLanes() { return lanes_.value(); }
  const std::shared_ptr<SharedModel>& getShared() const { return shared_; }
  const ResponseLayout& getLayout() const { return layout_; }

 private:
  void makeLanes() {
    if (shared_->lanes) {
      lanes_.emplace(*shared_->lanes, context_, SampleTask{layout_, shared_->box_center});
    }
  }

  SimbodyModel& updSimbody() {
    if (!simbody_) {
      const std::lock_guard<std::recursive_mutex> guard(building);
      simbody_ = makeSimbodyModel(shared_->known_to_simbody);
    }
    return *simbody_;
  }

  SampleStatus simulateBySimbody(const Eigen::Ref<const Eigen::VectorXd>& parameters,
                                 Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) {
    return updSimbody().simulate({shared_->layout, shared_->box_center}, parameters, response, sequence);
  }

  std::shared_ptr<SharedModel> shared_;
  ResponseLayout layout_;  ///< at other times than the shared one where it is of cloneAt()
  ModelContext context_;
  std::unique_ptr<SimbodyModel> simbody_;  ///< made when first used: lanes need none
  std::optional<LaneEngine> lanes_;
};

MultibodySimulator::MultibodySimulator(const ModelSpec& model, Eigen::VectorXd times, int modes,
                                       ModelCheck check) {
  const std::lock_guard<std::recursive_mutex> guard(building);
  impl_ = std::make_unique<Impl>(model, std::move(times), modes, check);
}

MultibodySimulator::MultibodySimulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MultibodySimulator::~MultibodySimulator() = default;

const ResponseLayout& MultibodySimulator::getLayout() const {
  return impl_->getLayout();
}

void MultibodySimulator::checkStart() {
  const std::lock_guard<std::recursive_mutex> guard(building);
  impl_->checkStart();
}

std::vector<std::string> MultibodySimulator::describeModel() {
  return impl_->describeModel();
}

const std::string& MultibodySimulator::getEngine() const {
  return impl_->getShared()->engine;
}

int MultibodySimulator::getBatchSize() const {
  return impl_->getShared()->lanes ? kLaneBatch : 1;
}

void MultibodySimulator::simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                  Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), impl_->getLayout(), parameters, responses);
  impl_->simulate(parameters, responses, statuses);
  explainStepLimits(impl_->getShared()->jumps, parameters.cols(), statuses);
}

void MultibodySimulator::simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                        Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), impl_->getLayout(), parameters, responses);
  impl_->simulateAround(parameters, responses, statuses);
  explainStepLimits(impl_->getShared()->jumps, parameters.cols(), statuses);
}

bool MultibodySimulator::hasDerivatives() const {
  return impl_->getShared()->lanes != nullptr;
}

void MultibodySimulator::simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                                 Eigen::Ref<Eigen::MatrixXd> responses,
                                                 Eigen::MatrixXd& derivatives, SampleStatus* statuses) {
  checkShapes(*impl_->getShared(), impl_->getLayout(), parameters, responses);
  impl_->updLanes().simulateWithDerivatives(parameters, responses, derivatives, statuses);
  explainStepLimits(impl_->getShared()->jumps, parameters.cols(), statuses);
}

std::unique_ptr<Simulator> MultibodySimulator::clonePrecisely() const {
  constexpr double kShare = 0.01, kMinRelative = 1e-13, kMinAbsolute = 1e-18;
  SharedModel& shared = *impl_->getShared();
  const std::lock_guard<std::mutex> guard(shared.making_precise);
  if (!shared.precise) {
    ModelSpec model = shared.model;
    SimulationSpec& simulation = model.simulation;
    simulation.relative_tolerance = std::max(kShare * simulation.relative_tolerance, kMinRelative);
    simulation.absolute_tolerance = std::max(kShare * simulation.absolute_tolerance, kMinAbsolute);
    shared.precise =
        std::make_unique<MultibodySimulator>(model, shared.layout.times, shared.layout.modes, shared.check);
  }
  return shared.precise->clone();
}

std::unique_ptr<Simulator> MultibodySimulator::clone() const {
  const std::lock_guard<std::recursive_mutex> guard(building);
  return std::unique_ptr<Simulator>(
      new MultibodySimulator(std::make_unique<Impl>(impl_->getShared(), impl_->getLayout())));
}

std::unique_ptr<Simulator> MultibodySimulator::cloneAt(const Eigen::VectorXd& times) const {
  const SharedModel& shared = *impl_->getShared();
  if (!shared.lanes || !shared.lanes->getValues().is_memoryless || shared.layout.modes > 0) {
    return nullptr;
  }
  const std::lock_guard<std::recursive_mutex> guard(building);
  ResponseLayout layout = shared.layout;
  layout.times = times;
  return std::unique_ptr<Simulator>(
      new MultibodySimulator(std::make_unique<Impl>(impl_->getShared(), std::move(layout))));
}

}  // namespace twinmap
