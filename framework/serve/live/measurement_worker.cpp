#include "framework/serve/live/measurement_worker.hpp"

#include <chrono>

#include "framework/base/json/json.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::serve {
namespace {

using Clock = std::chrono::steady_clock;

/// An fsync takes 1 to 10 ms: its share is small by then, and nobody notices the wait.
constexpr std::chrono::milliseconds kLongestHold{20};

/// An answer that nothing judges has none.
std::string readStatus(const Json& answer) {
  const auto found = answer.find("status");
  return found != answer.end() && found->is_string() ? found->get<std::string>() : "none";
}

}  // namespace

MeasurementWorker::MeasurementWorker(MeasurementService& service, Metrics& metrics, Committed committed,
                                     std::function<void()> failed)
    : service_(service), metrics_(metrics), committed_(std::move(committed)), failed_(std::move(failed)) {
  describeState();
  thread_ = std::thread([this] { work(); });
}

void MeasurementWorker::submit(Read read, Answered answered) {
  push({std::move(read), nullptr, std::move(answered)});
}

void MeasurementWorker::ask(std::function<std::string(const MeasurementService&)> question,
                            Answered answered) {
  push({nullptr, std::move(question), std::move(answered)});
}

void MeasurementWorker::push(Task task) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (finishes_) {
    lock.unlock();
    task.answered({Outcome::kFailed, "the server ends"});
    return;
  }
  tasks_.push_back(std::move(task));
  waiting_.notify_one();
}

std::shared_ptr<const std::string> MeasurementWorker::getState() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

std::size_t MeasurementWorker::countWaiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return tasks_.size();
}

std::string MeasurementWorker::getFailure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void MeasurementWorker::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    finishes_ = true;
  }
  waiting_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

/// All that wait; none at the end.
std::deque<MeasurementWorker::Task> MeasurementWorker::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  waiting_.wait(lock, [this] { return finishes_ || !tasks_.empty(); });
  return std::exchange(tasks_, {});
}

void MeasurementWorker::work() {
  for (std::deque<Task> tasks = take(); !tasks.empty(); tasks = take()) {
    Clock::time_point first = Clock::now();
    for (Task& task : tasks) {
      task.read ? answer(task) : answerQuestion(task);
      if (Clock::now() - first > kLongestHold) {
        release();
        first = Clock::now();
      }
    }
    release();
  }
}

void MeasurementWorker::answer(Task& task) {
  if (const std::string failure = getFailure(); !failure.empty()) {
    held_.push_back({std::move(task.answered), {Outcome::kFailed, failure}});
    return;
  }
  const Clock::time_point begin = Clock::now();
  Outcome outcome;
  std::string status = "error";
  try {
    const Json answer = service_.answer(task.read());
    status = readStatus(answer);
    last_answer_ = formatJson(answer);
    outcome.text = last_answer_ + "\n";
  } catch (const NotJson& error) {
    outcome = {Outcome::kUnread, error.what()};
  } catch (const ExperimentError& error) {
    outcome = {Outcome::kRefused, error.what()};
  } catch (const std::exception& error) {
    outcome = {Outcome::kFailed, error.what()};
  }
  metrics_.noteMeasurement(status, std::chrono::duration<double>(Clock::now() - begin).count());
  held_.push_back({std::move(task.answered), std::move(outcome)});
}

void MeasurementWorker::answerQuestion(const Task& task) {
  release();
  try {
    task.answered({Outcome::kAnswered, task.question(service_)});
  } catch (const std::exception& error) {
    task.answered({Outcome::kRefused, error.what()});
  }
}

/// Writes what is held, and lets it go.
void MeasurementWorker::release() {
  if (!held_.empty() && getFailure().empty()) {
    commit();
  }
  const std::string failure = getFailure();
  for (Held& held : std::exchange(held_, {})) {
    if (!failure.empty() && held.outcome.kind == Outcome::kAnswered) {
      held.outcome = {Outcome::kFailed, failure};
    }
    held.answered(std::move(held.outcome));
  }
}

void MeasurementWorker::commit() {
  try {
    service_.commit();
    metrics_.noteCommit();
    if (!last_answer_.empty()) {
      describeState();
      committed_("{\"state\": " + *getState() + ", \"answer\": " + last_answer_ + "}");
    }
  } catch (const std::exception& error) {
    fail(error.what());
  }
  last_answer_.clear();
}

void MeasurementWorker::fail(const std::string& what) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = what;
  }
  failed_();
}

void MeasurementWorker::describeState() {
  const Json state = service_.getState();
  metrics_.setState(state);
  auto text = std::make_shared<const std::string>(formatJson(state));
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = std::move(text);
}

}  // namespace twinmap::serve
