#include "framework/models/external/program_pool.hpp"

#include <fmt/core.h>

#include "framework/models/external/answer.hpp"

namespace twinmap {
namespace {

ProgramStart makeStart(const ProgramSpec& spec) {
  ProgramStart start{spec.command, spec.working_folder, {}, spec.memory};
  for (const EnvironmentSpec& variable : spec.environment) {
    start.environment.emplace_back(variable.name.text, variable.value);
  }
  return start;
}

}  // namespace

ProgramWorker::ProgramWorker(const ProgramSpec& spec, const std::string& hello) : process_(makeStart(spec)) {
  std::string answer;
  try {
    answer = process_.exchange(hello, spec.start_timeout);
  } catch (const WorkerFailure& failure) {
    throw WorkerFailure(fmt::format("before its first answer, {}, {}", writeHelloAnswer(), failure.what()),
                        failure.hasTimedOut());
  }
  checkHello(answer);
}

std::string ProgramWorker::exchange(const std::string& request, int samples, double timeout) {
  const std::string answer = process_.exchange(request, timeout);
  samples_ += samples;
  return answer;
}

bool ProgramWorker::hasGrown() {
  constexpr long kSamplesBetween = 32;   // so that reading it costs nothing
  constexpr double kMaxGrowth = 2.56e8;  // bytes; a few programs at once matter little
  if (samples_ - checked_ < kSamplesBetween) {
    return false;
  }
  checked_ = samples_;
  const double size = process_.getResidentSize();
  first_size_ = first_size_ > 0.0 ? first_size_ : size;
  return size - first_size_ > kMaxGrowth;
}

std::unique_ptr<ProgramWorker> ProgramPool::take(bool fresh) {
  {
    std::unique_lock<std::mutex> lock(access_);
    returned_.wait(lock, [&] { return !spec_.workers || taken_ < *spec_.workers; });
    ++taken_;
    if (!idle_.empty()) {
      std::unique_ptr<ProgramWorker> worker = std::move(idle_.back());
      idle_.pop_back();
      if (!fresh || worker->isFresh()) {
        return worker;
      }
    }  // the one that is not fresh ends, so that no more than asked for run
  }
  return start();
}

std::unique_ptr<ProgramWorker> ProgramPool::start() {
  try {
    auto worker = std::make_unique<ProgramWorker>(spec_, hello_);
    const std::lock_guard<std::mutex> lock(access_);
    has_started_ = true;
    return worker;
  } catch (const std::runtime_error& error) {
    giveBack(nullptr);
    const std::lock_guard<std::mutex> lock(access_);
    if (!has_started_) {
      throw ExperimentError("model.program: " + std::string(error.what()));
    }
    throw;
  }
}

void ProgramPool::giveBack(std::unique_ptr<ProgramWorker> worker) {
  {
    const std::lock_guard<std::mutex> lock(access_);
    --taken_;
    if (worker != nullptr && !worker->hasGrown()) {
      idle_.push_back(std::move(worker));
    }
  }
  returned_.notify_one();
}

}  // namespace twinmap
