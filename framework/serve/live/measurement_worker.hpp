#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "framework/serve/live/metrics.hpp"
#include "framework/serve/live/posted_measurement.hpp"

namespace twinmap::serve {

/// What came of a measurement or a question.
struct Outcome {
  enum Kind {
    kAnswered,  ///< what was answered is on disk
    kRefused,   ///< the measurement cannot be used; nothing has changed
    kUnread,    ///< nor can it be read as JSON
    kFailed     ///< it could not be worked on or written
  };
  Kind kind = kAnswered;
  std::string text;  ///< a line of JSON, or CSV; else what is wrong
};

using Answered = std::function<void(Outcome)>;  ///< called once, by the worker's thread or in submit()

/// Reads what came. Throws NotJson, or ExperimentError.
using Read = std::function<PostedMeasurement()>;

/// After measurements were written: how many there are, the belief, and the answer to the last of them.
using Committed = std::function<void(const std::string& event)>;

/// The one thread that infers and updates. Measurements are answered in the order in which they came. Those
/// that wait are answered together: one commit() for all that took 20 ms, or for the one that took longer.
/// After a commit() that failed nothing is answered any more.
class MeasurementWorker {
 public:
  /// committed and failed are called by the worker's thread. What is referred to must outlive the worker.
  MeasurementWorker(MeasurementService& service, Metrics& metrics, Committed committed,
                    std::function<void()> failed);
  MeasurementWorker(const MeasurementWorker&) = delete;
  MeasurementWorker& operator=(const MeasurementWorker&) = delete;
  ~MeasurementWorker() { finish(); }

  // From any thread.
  /// read: called by the worker's thread, as a large one takes its time.
  void submit(Read read, Answered answered);
  /// Asks the service something, in its turn: what it says is on disk.
  void ask(std::function<std::string(const MeasurementService&)> question, Answered answered);
  /// The belief as it was last written, a line of JSON.
  std::shared_ptr<const std::string> getState() const;
  std::size_t countWaiting() const;
  /// Of the commit() that failed; "".
  std::string getFailure() const;

  /// Answers what waits and ends. What is submitted later is answered with kFailed.
  void finish();

 private:
  struct Task {
    Read read;  // none: a question is to be answered
    std::function<std::string(const MeasurementService&)> question;
    Answered answered;
  };
  struct Held {
    Answered answered;
    Outcome outcome;
  };

  void push(Task task);
  std::deque<Task> take();
  void work();
  void answer(Task& task);
  void answerQuestion(const Task& task);
  void release();
  void commit();
  void fail(const std::string& what);
  void describeState();

  MeasurementService& service_;
  Metrics& metrics_;
  const Committed committed_;
  const std::function<void()> failed_;
  std::vector<Held> held_;    // answers that are not on disk yet; the worker's
  std::string last_answer_;   // of them; ""
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable waiting_;
  std::deque<Task> tasks_;
  std::shared_ptr<const std::string> state_;
  std::string failure_;
  bool finishes_ = false;
  std::thread thread_;
};

}  // namespace twinmap::serve
