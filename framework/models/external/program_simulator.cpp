#include "framework/models/external/program_simulator.hpp"

#include <limits>
#include <optional>
#include <stdexcept>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/external/answer.hpp"
#include "framework/models/external/program_pool.hpp"
#include "framework/models/external/requests.hpp"
#include "framework/simulation/model_numbers.hpp"
#include "framework/simulation/sensors.hpp"

namespace twinmap {
namespace {

void checkLayout(const ModelSpec& model, const Eigen::VectorXd& times, int modes) {
  if (modes > 0) {
    throw ExperimentError("a program has no natural frequencies: features of modes need a system");
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

std::string describeProgram(const std::vector<std::string>& command) {
  std::string text = "program";
  for (const std::string& word : command) {
    text += " " + word;
  }
  return text;
}

Eigen::VectorXd chooseExcitationTimes(const ModelSpec& model, const Eigen::VectorXd& times) {
  const std::optional<double>& interval = model.source->program->excitation_interval;
  return interval ? makeExcitationTimes(*interval, model.simulation.duration) : times;
}

}  // namespace

/// What the samples of one model need that is computed for each: numbers and excitation. For one thread.
class ProgramSimulator::Sampler {
 public:
  /// Evaluates everything once, so that all expressions are compiled.
  Sampler(const ModelSpec& model, const ResponseLayout& layout)
      : model_(model),
        layout_(layout),
        excitation_times_(chooseExcitationTimes(model, layout.times)),
        names_(collectProgramNames(model)),
        numbers_(model),
        excitation_(model.excitation) {
    try {
      update(calcBoxCenter(collectSampled(model)));
      Eigen::VectorXd response = Eigen::VectorXd::Zero(layout.getRowCount());
      applySensors(model_, numbers_, response);
      usual_ = calcTable();
    } catch (const SimulationFailure& failure) {
      throw ExperimentError(toString(failure.getWhere()) +
                            ": at the centre of the bounds: " + failure.what());
    }
  }

  std::string makeHello() const { return writeHello(names_, layout_, model_.simulation.duration, usual_); }

  /// Throws SimulationFailure for numbers that a model cannot have.
  std::string makeRequest(const Eigen::Ref<const Eigen::VectorXd>& point) {
    update(point);
    const ExcitationTable table = calcTable();
    return writeRequest(names_, collectValues(point), table == usual_ ? nullptr : &table);
  }

  void applySensorsOf(const Eigen::Ref<const Eigen::VectorXd>& point, Eigen::Ref<Eigen::VectorXd> response) {
    numbers_.update(point);
    applySensors(model_, numbers_, response);
  }

 private:
  void update(const Eigen::Ref<const Eigen::VectorXd>& point) {
    numbers_.update(point);
    excitation_.update(numbers_);
  }

  ExcitationTable calcTable() {
    return calcExcitationTable(excitation_, excitation_times_, model_.simulation.duration);
  }

  std::vector<double> collectValues(const Eigen::Ref<const Eigen::VectorXd>& point) {
    std::vector<double> values(point.begin(), point.end());
    for (const ConstantSpec& constant : model_.constants) {
      if (constant.variable) {
        values.push_back(numbers_.calc(constant.value, {constant.name.text, "value", ""}));
      }
    }
    return values;
  }

  const ModelSpec& model_;
  const ResponseLayout& layout_;
  const Eigen::VectorXd excitation_times_;
  const ProgramNames names_;
  ModelNumbers numbers_;
  Excitation excitation_;
  ExcitationTable usual_;  ///< at the centre of the box
};

/// What all clones share.
class ProgramSimulator::Shared {
 public:
  Shared(const ModelSpec& of, Eigen::VectorXd times)
      : model(of),
        layout(makeLayout(of, std::move(times))),
        names(collectProgramNames(of)),
        engine(describeProgram(of.source->program->command)),
        pool(*model.source->program, Sampler(model, layout).makeHello()) {}

  /// In a process that is as good as new where an older one fails.
  SampleStatus simulateOne(const std::string& request, Eigen::Ref<Eigen::VectorXd> response) {
    const Attempt first = tryOne(request, response, false);
    return first.repeat ? tryOne(request, response, true).status : first.status;
  }

  /// False where the batch failed as a whole, so that nothing is known of its samples.
  bool simulateTogether(const std::vector<std::string>& requests, Eigen::Ref<Eigen::MatrixXd> responses,
                        SampleStatus* statuses);

  const ModelSpec model;
  const ResponseLayout layout;
  const ProgramNames names;
  const std::string engine;
  ProgramPool pool;

 private:
  struct Attempt {
    SampleStatus status;
    bool repeat = false;  ///< samples before may be the cause
  };
  Attempt tryOne(const std::string& request, Eigen::Ref<Eigen::VectorXd> response, bool fresh);
};

ProgramSimulator::Shared::Attempt ProgramSimulator::Shared::tryOne(const std::string& request,
                                                                   Eigen::Ref<Eigen::VectorXd> response,
                                                                   bool fresh) {
  std::unique_ptr<ProgramWorker> worker;
  try {
    worker = pool.take(fresh);
  } catch (const WorkerFailure& failure) {
    return {{false, failure.what(), true}};
  } catch (const ProtocolError& error) {
    return {{false, error.what(), true}};
  }
  const bool repeat = !worker->isFresh();
  try {
    const SampleStatus status =
        readAnswer(worker->exchange(request, 1, pool.getSpec().timeout), names.outputs, layout, response);
    pool.giveBack(std::move(worker));
    return {status};
  } catch (const WorkerFailure& failure) {
    pool.giveBack(nullptr);
    return {{false, failure.what(), failure.hasTimedOut()}, repeat && !failure.hasTimedOut()};
  } catch (const ProtocolError& error) {
    pool.giveBack(nullptr);
    return {{false, error.what()}, repeat};
  }
}

bool ProgramSimulator::Shared::simulateTogether(const std::vector<std::string>& requests,
                                                Eigen::Ref<Eigen::MatrixXd> responses,
                                                SampleStatus* statuses) {
  const int count = static_cast<int>(requests.size());
  std::unique_ptr<ProgramWorker> worker;
  try {
    worker = pool.take();
  } catch (const WorkerFailure&) {
    return false;
  } catch (const ProtocolError&) {
    return false;
  }
  try {
    const std::string line = worker->exchange(writeBatch(requests), count, count * pool.getSpec().timeout);
    readAnswers(line, names.outputs, layout, responses, statuses);
    pool.giveBack(std::move(worker));
    return true;
  } catch (const WorkerFailure&) {
  } catch (const ProtocolError&) {
  }
  pool.giveBack(nullptr);
  return false;
}

ProgramSimulator::ProgramSimulator(const ModelSpec& model, Eigen::VectorXd times, int modes) {
  checkLayout(model, times, modes);
  shared_ = std::make_shared<Shared>(model, std::move(times));
  sampler_ = std::make_unique<Sampler>(shared_->model, shared_->layout);
}

ProgramSimulator::ProgramSimulator(std::shared_ptr<Shared> shared)
    : shared_(std::move(shared)), sampler_(std::make_unique<Sampler>(shared_->model, shared_->layout)) {}

ProgramSimulator::~ProgramSimulator() = default;

const ResponseLayout& ProgramSimulator::getLayout() const {
  return shared_->layout;
}

const std::string& ProgramSimulator::getEngine() const {
  return shared_->engine;
}

int ProgramSimulator::getBatchSize() const {
  return shared_->pool.getSpec().batch;
}

void ProgramSimulator::checkStart() {
  const Eigen::VectorXd center = calcBoxCenter(collectSampled(shared_->model));
  Eigen::MatrixXd response(getLayout().getRowCount(), 1);
  SampleStatus status;
  simulate(center, response, &status);
  if (!status.ok) {
    throw ExperimentError("model.program: cannot simulate the centre of the bounds: " + status.reason);
  }
}

void ProgramSimulator::simulate(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  if (parameters.rows() != countSampled(shared_->model) || responses.rows() != getLayout().getRowCount() ||
      responses.cols() != parameters.cols()) {
    throw std::invalid_argument("ProgramSimulator::simulate: a matrix has the wrong shape");
  }
  const Eigen::Index most = getBatchSize();
  for (Eigen::Index first = 0; first < parameters.cols(); first += most) {
    const Eigen::Index count = std::min(most, parameters.cols() - first);
    simulateBatch(parameters.middleCols(first, count), responses.middleCols(first, count), statuses + first);
  }
}

void ProgramSimulator::simulateBatch(const Eigen::Ref<const Eigen::MatrixXd>& parameters,
                                     Eigen::Ref<Eigen::MatrixXd> responses, SampleStatus* statuses) {
  std::vector<std::string> requests;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    try {
      requests.push_back(sampler_->makeRequest(parameters.col(i)));
      columns.push_back(i);
      statuses[i] = {};
    } catch (const SimulationFailure& failure) {
      statuses[i] = {false, failure.what()};
    }
  }
  const bool whole = requests.size() > 1 && static_cast<Eigen::Index>(requests.size()) == parameters.cols();
  if (!whole || !shared_->simulateTogether(requests, responses, statuses)) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      statuses[columns[i]] = shared_->simulateOne(requests[i], responses.col(columns[i]));
    }
  }
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    finish(parameters.col(i), responses.col(i), statuses[i]);
  }
}

void ProgramSimulator::finish(const Eigen::Ref<const Eigen::VectorXd>& point,
                              Eigen::Ref<Eigen::VectorXd> response, SampleStatus& status) {
  if (status.ok) {
    try {
      sampler_->applySensorsOf(point, response);
    } catch (const SimulationFailure& failure) {
      status = {false, failure.what()};
    }
  }
  if (!status.ok) {
    response.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

std::unique_ptr<Simulator> ProgramSimulator::clone() const {
  return std::unique_ptr<Simulator>(new ProgramSimulator(shared_));
}

}  // namespace twinmap
