#include "framework/fmi/worker.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

#include "framework/fmi/runner.hpp"
#include "framework/fmi/worker_job.hpp"
#include "framework/process/serve_frames.hpp"
#include "framework/simulation/model_numbers.hpp"
#include "framework/simulation/sensors.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap::fmi {
namespace {

constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // whose shadow memory takes terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

void limitMemory(double gibibytes) {
  const double bytes = std::min(gibibytes * kGibibyte, 1e18);
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  if (!kSanitized) {
    setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core{0, 0};  // a crash is expected and leaves no file
  setrlimit(RLIMIT_CORE, &no_core);
}

/// Bytes in memory.
double getResidentSize() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// An FMU that grows is replaced before it takes the machine's memory.
class GrowthWatch {
 public:
  bool hasGrown() {
    constexpr int kSamplesBetween = 32;     // so that reading it costs nothing
    constexpr double kMostGrowth = 2.56e8;  // bytes since the first sample; a few FMUs at once matter little
    if (count_++ % kSamplesBetween != 0) {
      return false;
    }
    const double size = getResidentSize();
    first_ = first_ == 0.0 ? size : first_;
    return size - first_ > kMostGrowth;
  }

 private:
  int count_ = 0;
  double first_ = 0.0;
};

/// One FMU with all that its samples share.
class FmuWorker {
 public:
  explicit FmuWorker(WorkerJob job)
      : job_(std::move(job)),
        description_(
            readModelDescription(std::filesystem::path(job_.folder) / "modelDescription.xml", job_.file)),
        sampled_(static_cast<std::size_t>(countSampled(job_.model))),
        numbers_(job_.model),
        excitation_(job_.model.excitation),
        response_(static_cast<Eigen::Index>(job_.model.outputs.size() * job_.times.size())),
        runner_(
            {description_, toKind(job_.kind), job_.library, std::filesystem::path(job_.folder) / "resources"},
            makeRunSetting(description_, toKind(job_.kind), job_.model, job_.times),
            excitation_.getSignalCount()) {}

  /// The first byte tells whether this process ends now; then an answer for each point.
  Frame answer(const Frame& request, bool& last) {
    const std::size_t size = std::max<std::size_t>(sampled_ * sizeof(double), 1);
    const std::size_t count = std::max<std::size_t>(request.size() / size, 1);
    Eigen::MatrixXd points(static_cast<Eigen::Index>(sampled_), static_cast<Eigen::Index>(count));
    std::memcpy(points.data(), request.data(), std::min(request.size(), count * size));
    StepSequence steps_of_center;
    Frame frame{0};
    for (const auto& point : points.colwise()) {
      const SampleStatus status = simulate(point, steps_of_center);
      const Frame one = encodeAnswer(status, response_);
      frame.insert(frame.end(), one.begin(), one.end());
    }
    last = !runner_.isUsable() || growth_.hasGrown();
    frame[0] = static_cast<char>(last);
    return frame;
  }

 private:
  SampleStatus simulate(const Eigen::VectorXd& point, StepSequence& sequence) {
    if (!runner_.isUsable()) {
      return {false, "the FMU has ended with Fatal at a neighbour"};
    }
    try {
      numbers_.update(point);
      excitation_.update(numbers_.updNumbers());
      SampleStatus status = runner_.run(collectValues(point).data(), excitation_, response_, sequence);
      if (status.ok) {
        applySensors(job_.model, numbers_, response_);
      }
      return status;
    } catch (const SimulationFailure& failure) {
      return {false, failure.what()};
    }
  }

  /// The parameter point, then the constants.
  std::vector<double> collectValues(const Eigen::VectorXd& point) {
    std::vector<double> values(point.begin(), point.end());
    for (const ConstantSpec& constant : job_.model.constants) {
      values.push_back(numbers_.updNumbers().calc(constant.value, {constant.name.text, "value", ""}));
    }
    return values;
  }

  const WorkerJob job_;
  const ModelDescription description_;
  const std::size_t sampled_;  ///< parameters of a point
  ModelNumbers numbers_;
  Excitation excitation_;
  Eigen::VectorXd response_;
  Runner runner_;
  GrowthWatch growth_;
};

Frame begin(const Frame& request, std::optional<FmuWorker>& worker) {
  try {
    WorkerJob job = readWorkerJob({request.begin(), request.end()});
    limitMemory(job.model.source->fmu->memory);
    std::filesystem::current_path(
        job.folder);  // what the model writes by relative names goes with the folder
    worker.emplace(std::move(job));
    return {};
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    return {reason.begin(), reason.end()};
  }
}

}  // namespace

void runWorker() {
  std::optional<FmuWorker> worker;
  serveFrames([&worker](const Frame& request, bool& last) {
    return worker ? worker->answer(request, last) : begin(request, worker);
  });
}

}  // namespace twinmap::fmi
