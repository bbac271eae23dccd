#include "framework/models/fmu/fmu_simulator.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/worker.hpp"
#include "framework/models/fmu/worker_job.hpp"

namespace twinmap {
namespace {

constexpr double kStartTime = 60.0;  // s that an FMU may take to be loaded
constexpr double kGrace = 2.0;  // s beyond a sample's limit, which the process keeps itself unless it hangs

std::vector<double> toVector(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

std::optional<fmi::Kind> getKind(const FmuSpec& spec) {
  return spec.kind ? std::optional<fmi::Kind>(fmi::toKind(*spec.kind)) : std::nullopt;
}

void checkLayout(const ModelSpec& model, const Eigen::VectorXd& times, int modes) {
  if (modes > 0) {
    throw ExperimentError(model.source->fmu->file.where, model.source->fmu->file.text,
                          "has no natural frequencies: features of modes need a system");
  }
  checkSampleTimes(times, model.simulation.duration);
}

ResponseLayout makeLayout(const ModelSpec& model, Eigen::VectorXd times) {
  ResponseLayout layout{collectNames(model.outputs), {}, std::move(times), 0};
  for (const OutputSpec& output : model.outputs) {
    layout.output_units.push_back(output.unit);
  }
  return layout;
}

/// Without the name of the file, which messages have.
std::string getFileName(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

WorkerCommand makeWorkerCommand() {
  WorkerCommand command = getWorkerProgram();
  command.arguments.emplace_back(fmi::kWorkerArgument);
  return command;
}

}  // namespace

/// A process with the FMU.
class FmuSimulator::Worker {
 public:
  explicit Worker(const std::string& job) : process_(makeWorkerCommand()) {
    const Frame refusal = process_.exchange(fmi::encodeJob(job), kStartTime);
    if (!refusal.empty()) {
      throw WorkerFailure(std::string(refusal.begin(), refusal.end()));
    }
  }

  /// `limit`: s a sample.
  void simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters, Eigen::Ref<Eigen::MatrixXd> responses,
                SampleStatus* statuses, double limit) {
    const double timeout = static_cast<double>(parameters.cols()) * limit + kGrace;
    const Frame answers = process_.exchange(fmi::encodePoints(parameters), timeout);
    std::size_t begin = 1;
    for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
      statuses[i] = fmi::decodeAnswer(answers, begin, responses.col(i));
    }
    noteAnswer(answers);
  }

  /// `answer`: the response and its derivatives. `limit`: s a sample.
  void simulateWithDerivatives(const Eigen::Ref<const Eigen::VectorXd>& point,
                               Eigen::Ref<Eigen::VectorXd> answer, SampleStatus& status, double limit) {
    const auto samples =
        static_cast<double>(4 * point.size() + 4);  // by differences, and those of the centre
    const Frame answers = process_.exchange(fmi::encodePoint(point), samples * limit + kGrace);
    std::size_t begin = 1;
    status = fmi::decodeAnswer(answers, begin, answer);
    noteAnswer(answers);
  }

  /// Whether it has ended by itself after its last answer.
  bool hasEnded() const { return last_; }
  bool isFresh() const { return fresh_; }

 private:
  void noteAnswer(const Frame& answers) {
    last_ = answers.front() != 0;
    fresh_ = false;
  }

  WorkerProcess process_;
  bool last_ = false, fresh_ = true;
};

/// What all clones share: the unpacked FMU, and processes that no clone uses at present.
class FmuSimulator::Shared {
 public:
  Shared(const ModelSpec& model, Eigen::VectorXd times)
      : model_(model),
        package_(model.source->fmu->file.text),
        kind_(package_.chooseKind(getKind(*model.source->fmu))),
        layout_(makeLayout(model, std::move(times))) {
    const fmi::RunSetting setting = fmi::makeRunSetting(package_.getDescription(), kind_, model_,
                                                        toVector(layout_.times));  // names and units fit
    has_derivatives_ = fmi::makeSensitivityPlan(package_.getDescription(), model_, setting).has_value();
    const std::string library = package_.requireLibrary(kind_).string();
    job_ = fmi::writeWorkerJob({model.source->fmu->file.text, package_.getFolder().string(), library,
                                fmi::toFmuKind(kind_), model_, toVector(layout_.times)});
    engine_ =
        "fmu " + getFileName(model.source->fmu->file.text) + " (FMI " +
        package_.getDescription().version_text + ", " + toText(kind_) +
        (package_.getDescription().getCapabilities(kind_).needs_execution_tool ? ", needs its tool" : "") +
        (has_derivatives_ ? ", its derivatives" : "") + ")";
  }

  std::unique_ptr<Worker> takeWorker() {
    {
      const std::lock_guard<std::mutex> guard(access_);
      if (!idle_.empty()) {
        std::unique_ptr<Worker> worker = std::move(idle_.back());
        idle_.pop_back();
        return worker;
      }
    }
    return makeWorker();
  }

  std::unique_ptr<Worker> makeWorker() const { return std::make_unique<Worker>(job_); }

  void giveBack(std::unique_ptr<Worker> worker) {
    const std::lock_guard<std::mutex> guard(access_);
    idle_.push_back(std::move(worker));
  }

  template <class Make>
  std::unique_ptr<Simulator> clonePrecise(const Make& make) {
    const std::lock_guard<std::mutex> guard(making_precise_);
    precise_ = precise_ != nullptr ? std::move(precise_) : make();
    return precise_->clone();
  }

  /// Whether neighbours take the integration steps of their centre: then they are smooth.
  bool sharesSteps() const {
    return kind_ == fmi::Kind::kModelExchange && package_.getDescription().event_indicators == 0;
  }

  template <class Measure>
  const DifferenceSteps& getDifferenceSteps(const Measure& measure) {
    std::call_once(measuring_steps_, [&] { steps_ = measure(); });
    return steps_;
  }

  const ModelSpec& getModel() const { return model_; }
  const ResponseLayout& getLayout() const { return layout_; }
  const std::string& getEngine() const { return engine_; }
  bool hasDerivatives() const { return has_derivatives_; }

 private:
  const ModelSpec model_;
  const fmi::Package package_;
  const fmi::Kind kind_;
  const ResponseLayout layout_;
  std::string job_, engine_;
  bool has_derivatives_ = false;
  std::once_flag measuring_steps_;
  DifferenceSteps steps_;
  std::mutex access_;
  std::mutex making_precise_;
  std::unique_ptr<FmuSimulator> precise_;  ///< made when first used
  std::vector<std::unique_ptr<Worker>> idle_;
};

FmuSimulator::FmuSimulator(const ModelSpec& model, Eigen::VectorXd times, int modes) {
  checkLayout(model, times, modes);
  shared_ = std::make_shared<Shared>(model, std::move(times));
}

FmuSimulator::FmuSimulator(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

FmuSimulator::~FmuSimulator() {
  if (worker_ != nullptr) {
    shared_->giveBack(std::move(worker_));
  }
}

const ResponseLayout& FmuSimulator::getLayout() const {
  return shared_->getLayout();
}

const std::string& FmuSimulator::getEngine() const {
  return shared_->getEngine();
}

void FmuSimulator::checkStart() {
  const Eigen::MatrixXd center = calcBoxCenter(collectSampled(shared_->getModel()));
  Eigen::MatrixXd response(getLayout().getRowCount(), 1);
  SampleStatus status;
  simulate(center, response, &status);
  if (!status.ok) {
    const Name& file = shared_->getModel().source->fmu->file;
    throw ExperimentError(file.where, file.text,
                          "cannot be simulated at the centre of the bounds: " + status.reason);
  }
}

void FmuSimulator::checkShapes(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                               const Eigen::Ref<Eigen::MatrixXd>& responses) const {
  if (parameters.rows() != countSampled(shared_->getModel()) ||
      responses.rows() != getLayout().getRowCount() || responses.cols() != parameters.cols()) {
    throw std::invalid_argument("FmuSimulator::simulate: a matrix has the wrong shape");
  }
}

void FmuSimulator::simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                            Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(parameters, responses);
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    simulateTogether(parameters.col(i), responses.col(i), &statuses[i]);
  }
}

void FmuSimulator::simulateAround(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                  Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  checkShapes(parameters, responses);
  if (shared_->sharesSteps() || getDifferenceSteps().areShared()) {
    return simulateTogether(parameters, responses, statuses);
  }
  simulateOnTangent(
      collectSampled(shared_->getModel()), getDifferenceSteps(),
      [this](const Eigen::MatrixXd& points, Eigen::MatrixXd& found, std::vector<SampleStatus>& own) {
        simulateTogether(points, found, own.data());
      },
      parameters, responses, statuses);
}

const DifferenceSteps& FmuSimulator::getDifferenceSteps() {
  return shared_->getDifferenceSteps([this] {
    return measureDifferenceSteps(
        collectSampled(shared_->getModel()), getLayout(),
        [this](const Eigen::MatrixXd& points, Eigen::MatrixXd& found, std::vector<SampleStatus>& own) {
          simulateTogether(points, found, own.data());
        });
  });
}

void FmuSimulator::simulateTogether(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                    Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  attempt(
      [&](Worker& worker) {
        worker.simulate(parameters, responses, statuses, shared_->getModel().simulation.max_wall_time);
      },
      statuses, parameters.cols());
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    if (!statuses[i].ok) {
      responses.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

std::string FmuSimulator::describeDifferences() {
  return shared_->sharesSteps() ? "" : describe(getDifferenceSteps());
}

template <class Exchange>
void FmuSimulator::attempt(const Exchange& exchange, SampleStatus* statuses, Eigen::Index count) {
  for (const bool fresh : {false, true}) {
    bool may_repeat = false;
    try {
      if (worker_ == nullptr) {
        worker_ = fresh ? shared_->makeWorker() : shared_->takeWorker();
      }
      may_repeat = !worker_->isFresh();
      exchange(*worker_);
      if (worker_->hasEnded()) {
        worker_ = nullptr;
      }
      return;
    } catch (const WorkerFailure& failure) {
      worker_ = nullptr;
      std::fill(statuses, statuses + count, SampleStatus{false, failure.what(), failure.hasTimedOut()});
      if (!may_repeat || failure.hasTimedOut()) {
        return;
      }
    }
  }
}

bool FmuSimulator::hasDerivatives() const {
  return shared_->hasDerivatives();
}

void FmuSimulator::simulateWithDerivatives(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                           Eigen::Ref<Eigen::MatrixXd> responses,
                                           Eigen::MatrixXd& derivatives, SampleStatus* statuses) {
  checkShapes(parameters, responses);
  const Eigen::Index p = parameters.rows();
  derivatives.resize(responses.rows(), p * parameters.cols());
  Eigen::VectorXd answer(responses.rows() * (1 + p));
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    attempt(
        [&](Worker& worker) {
          worker.simulateWithDerivatives(parameters.col(i), answer, statuses[i],
                                         shared_->getModel().simulation.max_wall_time);
        },
        &statuses[i], 1);
    if (!statuses[i].ok) {
      answer.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    responses.col(i) = answer.head(responses.rows());
    derivatives.middleCols(i * p, p) = answer.tail(responses.rows() * p).reshaped(responses.rows(), p);
  }
}

std::unique_ptr<Simulator> FmuSimulator::clone() const {
  return std::unique_ptr<Simulator>(new FmuSimulator(shared_));
}

std::unique_ptr<Simulator> FmuSimulator::clonePrecisely() const {
  return shared_->clonePrecise([this] {
    constexpr double kShare = 0.01, kMinRelative = 1e-13, kMinAbsolute = 1e-18;  // as MultibodySimulator
    ModelSpec model = shared_->getModel();
    SimulationSpec& simulation = model.simulation;
    simulation.relative_tolerance = std::max(kShare * simulation.relative_tolerance, kMinRelative);
    simulation.absolute_tolerance = std::max(kShare * simulation.absolute_tolerance, kMinAbsolute);
    return std::make_unique<FmuSimulator>(model, getLayout().times, 0);
  });
}

}  // namespace twinmap
