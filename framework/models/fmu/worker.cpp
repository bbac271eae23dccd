#include "framework/models/fmu/worker.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <thread>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/fmu/run/runner.hpp"
#include "framework/models/fmu/worker_job.hpp"
#include "framework/simulation/model_numbers.hpp"
#include "framework/simulation/sensors.hpp"
#include "framework/simulation/stencil.hpp"

namespace twinmap::fmi {
namespace {

/// Waits until the other side has closed the channel.
[[noreturn]] void watch(int channel) {
  pollfd file{channel, POLLRDHUP, 0};
  while (poll(&file, 1, -1) < 0 || (file.revents & (POLLRDHUP | POLLHUP | POLLERR)) == 0) {
  }
  kill(0, SIGKILL);  // and whatever the model has started
  _exit(1);
}

void receive(int channel, char* data, std::size_t size) {
  for (std::size_t received = 0; received < size;) {
    const ssize_t count = recv(channel, data + received, size - received, 0);
    if (count > 0) {
      received += static_cast<std::size_t>(count);
    } else if (count == 0 || errno != EINTR) {
      _exit(0);
    }
  }
}

void send(int channel, const char* data, std::size_t size) {
  for (std::size_t sent = 0; sent < size;) {
    const ssize_t count = ::send(channel, data + sent, size - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      _exit(0);
    }
  }
}

/// The worker's side of WorkerProcess: answers requests until the other side is gone. Should that happen
/// while a request is worked on, a thread of its own ends this process and its group at once. `answer` may
/// set `last` to end after its answer. Never returns: nothing of what the model has loaded runs after it.
[[noreturn]] void serveFrames(const std::function<Frame(const Frame& request, bool& last)>& answer) {
  const int channel = fcntl(kWorkerChannel, F_DUPFD_CLOEXEC, kWorkerChannel + 1);
  close(kWorkerChannel);  // what the model starts does not inherit it
  std::thread(watch, channel).detach();
  for (bool last = false; !last;) {
    std::uint64_t size = 0;
    receive(channel, reinterpret_cast<char*>(&size), sizeof size);
    Frame request(size);
    receive(channel, request.data(), request.size());
    const Frame reply = answer(request, last);
    std::fflush(nullptr);  // what the model has printed belongs to this request
    const std::uint64_t reply_size = reply.size();
    send(channel, reinterpret_cast<const char*>(&reply_size), sizeof reply_size);
    send(channel, reply.data(), reply.size());
  }
  _exit(0);
}

constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

// Sanitizers' shadow memory takes terabytes of addresses. GCC names them by macros, clang by features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
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
    constexpr int kSamplesBetween = 32;    // so that reading it costs nothing
    constexpr double kMaxGrowth = 2.56e8;  // bytes since the first sample; a few FMUs at once matter little
    if (count_++ % kSamplesBetween != 0) {
      return false;
    }
    const double size = getResidentSize();
    first_ = first_ == 0.0 ? size : first_;
    return size - first_ > kMaxGrowth;
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
        setting_(makeRunSetting(description_, toKind(job_.kind), job_.model, job_.times)),
        plan_(makeSensitivityPlan(description_, job_.model, setting_)),
        runner_(
            {description_, toKind(job_.kind), job_.library, std::filesystem::path(job_.folder) / "resources"},
            setting_, excitation_.getSignalCount()) {}

  /// The first byte tells whether this process ends now; then an answer for each point.
  Frame answer(const Frame& request, bool& last) {
    const Eigen::MatrixXd points = decodePoints(request);
    IntegrationPath path_of_center;
    Frame frame{0};
    if (!request.empty() && request[0] == static_cast<char>(Request::kDerivatives)) {
      Eigen::MatrixXd answer(response_.size(), 1 + points.rows());
      const SampleStatus status = simulateWithDerivatives(points.col(0), answer);
      frame = join(frame, encodeAnswer(status, answer.reshaped()));
    } else {
      for (const auto& point : points.colwise()) {
        const SampleStatus status = simulate(point, path_of_center);
        frame = join(frame, encodeAnswer(status, response_));
      }
    }
    last = !runner_.isUsable() || growth_.hasGrown();
    frame[0] = static_cast<char>(last);
    return frame;
  }

 private:
  static Frame join(Frame first, const Frame& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }

  Eigen::MatrixXd decodePoints(const Frame& request) const {
    const std::size_t size = std::max<std::size_t>(sampled_ * sizeof(double), 1);
    const std::size_t bytes = request.empty() ? 0 : request.size() - 1;  // behind what is asked for
    const std::size_t count = std::max<std::size_t>(bytes / size, 1);
    Eigen::MatrixXd points(static_cast<Eigen::Index>(sampled_), static_cast<Eigen::Index>(count));
    std::memcpy(points.data(), request.data() + 1, std::min(bytes, count * size));
    return points;
  }

  /// The response, then its derivatives: from the FMU, or else by differences of neighbours with the same
  /// steps.
  SampleStatus simulateWithDerivatives(const Eigen::VectorXd& point, Eigen::Ref<Eigen::MatrixXd> answer) {
    IntegrationPath path;
    const bool trusted = trustsDerivatives();
    SampleStatus status = simulate(point, path);
    answer.col(0) = response_;
    if (status.ok && !(trusted && calcExactly(point, path, answer.rightCols(point.size())))) {
      status = calcByDifferences(point, path, answer.rightCols(point.size()));
    }
    return status;
  }

  /// False where the FMU cannot tell.
  bool calcExactly(const Eigen::VectorXd& point, IntegrationPath& path,
                   Eigen::Ref<Eigen::MatrixXd> derivatives) {
    const bool exact =
        plan_ && !path.steps.empty() && path.method == HybridMethod::kExplicit &&
        runner_.runDerivatives(collectValues(point).data(), excitation_, path, *plan_, derivatives);
    if (exact) {
      applyGains(job_.model, numbers_, derivatives);
    }
    return exact;
  }

  SampleStatus calcByDifferences(const Eigen::VectorXd& point, IntegrationPath& path,
                                 Eigen::Ref<Eigen::MatrixXd> derivatives) {
    const std::vector<ParameterSpec> sampled = collectSampled(job_.model);
    const Eigen::MatrixXd points = makeNeighbours(sampled, point);
    Eigen::MatrixXd responses(response_.size(), points.cols());
    SampleStatus status;
    for (Eigen::Index i = 0; i < points.cols() && status.ok; ++i) {
      status = simulate(points.col(i), path);
      responses.col(i) = response_;
    }
    derivatives = calcDifferences(responses, sampled, point) * calcWidths(sampled).asDiagonal().inverse();
    return status;
  }

  /// Whether the derivatives that the FMU offers are those of its outputs: compared with differences at the
  /// centre of the box, once.
  bool trustsDerivatives() {
    constexpr double kTrusted = 1e-3;  // of the largest; differences err by less, what is wrong by more
    if (!trusts_) {
      const Eigen::VectorXd center = calcBoxCenter(collectSampled(job_.model));
      Eigen::MatrixXd exact(response_.size(), center.size()), differences(response_.size(), center.size());
      IntegrationPath path;
      trusts_ = simulate(center, path).ok && calcExactly(center, path, exact) &&
                calcByDifferences(center, path, differences).ok &&
                ((exact - differences).colwise().lpNorm<Eigen::Infinity>().array() <=
                 kTrusted * differences.colwise().lpNorm<Eigen::Infinity>().array())
                    .all();
    }
    return *trusts_;
  }

  SampleStatus simulate(const Eigen::VectorXd& point, IntegrationPath& path) {
    if (!runner_.isUsable()) {
      return {false, "the FMU has ended with Fatal at a neighbour"};
    }
    try {
      numbers_.update(point);
      excitation_.update(numbers_);
      SampleStatus status = runner_.run(collectValues(point).data(), excitation_, response_, path);
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
      values.push_back(numbers_.calc(constant.value, {constant.name.text, "value", ""}));
    }
    return values;
  }

  const WorkerJob job_;
  const ModelDescription description_;
  const std::size_t sampled_;  ///< parameters of a point
  ModelNumbers numbers_;
  Excitation excitation_;
  Eigen::VectorXd response_;
  const RunSetting setting_;
  const std::optional<SensitivityPlan> plan_;
  std::optional<bool> trusts_;  ///< none: not compared yet
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
