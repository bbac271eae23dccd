#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <set>
#include <stdexcept>
#include <thread>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/digest.hpp"
#include "framework/base/files/settled_files.hpp"
#include "framework/base/json/json.hpp"
#include "framework/cli/commands/measurements/track_options.hpp"
#include "framework/cli/signals.hpp"
#include "framework/cli/waiting_line.hpp"
#include "framework/data/measurement/files/time_stamp.hpp"
#include "framework/inference/measurement/measurement_stream.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap::cli {
namespace {

namespace fs = std::filesystem;

std::optional<double> readTime(const std::string& text) {
  double time = 0.0;
  if (text.empty()) {
    return {};
  }
  if (!parseTime(text, time)) {
    throw ExperimentError("--at: '" + text +
                          "' must be a date and time (2026-11-26T10:00:00Z) or seconds since 1970");
  }
  return time;
}

/// Tracks one measurement after another, a line of JSON each. One that cannot be used is an error of its own.
class TrackCommand {
 public:
  explicit TrackCommand(const TrackArguments& arguments)
      : source_(arguments.run),
        session_(source_, arguments.state, makeTrackOptions(arguments)),
        context_{readTime(arguments.at), arguments.start, arguments.trial},
        windows_(arguments.windows) {}

  void trackFile(const fs::path& file) {
    if (windows_) {
      trackWindows(file);
    } else {
      track(file.string(), [&] { return session_.updateFile(file, context_); });
    }
  }

  /// What of a folder was not tracked yet; follow: and what comes into it, until a signal.
  void trackFolder(const fs::path& folder, bool follow) {
    constexpr std::chrono::milliseconds kLook{200};  // a fifth of what a file takes to be seen as complete
    const StopFlags signals = catchSignals();
    follows_ = true;
    const std::vector<std::string> list = session_.listCounted();
    counted_.insert(list.begin(), list.end());
    SettledFiles files(folder, {".csv", ".txt", ".tsv", ".dat", ".mat"});
    for (bool is_done = false; !is_done && !signals.stop;) {
      trackInOrder(files.take(SettledFiles::Clock::now()), signals);
      is_done = !follow && !files.areSettling();
      if (!is_done) {
        keepSignals();
        std::this_thread::sleep_for(kLook);
      }
    }
  }

  void trackStream(std::istream& stream) {
    MeasurementStream measurements(stream);
    std::string text;
    for (int i = 1; measurements.next(text); ++i) {
      const std::string name = "measurement " + std::to_string(i);
      track(name, [&] { return session_.update(text, name, context_); });
    }
  }

  /// Throws std::runtime_error if a measurement could not be used.
  void finish(const TrackArguments& arguments) const {
    std::cout.flush();
    if (!arguments.history.empty()) {
      writeTextFile(arguments.history, session_.makeHistory());
    }
    if (!arguments.page.empty()) {
      writeTextFile(arguments.page, session_.makePage());
      std::cerr << "Page: " << arguments.page << "\n";
    }
    if (errors_ > 0) {
      throw std::runtime_error(fmt::format("{} of {} measurements could not be used", errors_, count_));
    }
  }

 private:
  /// In the order of times, of equal ones that of names. What states no time that can be read is tracked
  /// as it comes, which says what is wrong with it.
  void trackInOrder(const std::vector<fs::path>& files, const StopFlags& signals) {
    std::vector<std::pair<double, fs::path>> timed;
    for (const fs::path& file : files) {
      if (counted_.insert(toHex(calcFileDigest(file))).second) {
        timed.emplace_back(readTimeOf(file), file);
      }
    }
    std::sort(timed.begin(), timed.end());
    for (const auto& [time, file] : timed) {
      if (signals.stop) {
        return;
      }
      trackFile(file);
    }
  }

  void trackWindows(const fs::path& file) {
    double begin = 0.0;
    std::vector<double> starts;
    const bool is_read = attempt(file.string(), [&] {
      begin = session_.readTime(file, context_.trial).value_or(0.0);
      starts = session_.listWindows(file, context_, *windows_);
    });
    count_ += is_read ? 0 : 1;
    for (const double start : starts) {
      const MeasurementContext window{begin + start, start, context_.trial};
      track(file.string(), [&] { return session_.updateFile(file, window); });
    }
  }

  double readTimeOf(const fs::path& file) const {
    try {
      return session_.readTime(file, context_.trial).value_or(0.0);
    } catch (const std::exception&) {
      return 0.0;
    }
  }

  template <class Update>
  void track(const std::string& name, const Update& update) {
    ++count_;
    attempt(name, [&] {
      WaitingLine waiting("track " + name);
      const Json answer = update();
      session_.commit();
      waiting.clear();
      keepSignals();
      std::cout << formatJson(answer) << '\n';
      std::cout.flush();
    });
  }

  /// What waited has let go of signals, which end the process then: not between an answer and the next look.
  void keepSignals() const {
    if (follows_) {
      catchSignals();
    }
  }

  /// False, and an error that is printed, where it throws.
  template <class Action>
  bool attempt(const std::string& name, const Action& action) {
    try {
      action();
      return true;
    } catch (const std::exception& error) {
      ++errors_;
      keepSignals();
      std::cout << makeErrorJson(name, context_.start.value_or(0.0), error.what()) << '\n';
      std::cout.flush();
      std::cerr << "twinmap: error: " << error.what() << "\n";
      return false;
    }
  }

  const TwinSource source_;
  TrackSession session_;
  const MeasurementContext context_;
  const std::optional<double> windows_;  // s
  std::set<std::string> counted_;        // digests, of a folder's files
  int count_ = 0, errors_ = 0;
  bool follows_ = false;  ///< until a signal
};

void requireOneSource(const TrackArguments& arguments) {
  const bool comes = arguments.follow || !arguments.folder.empty();
  if (!arguments.files.empty() && comes) {
    throw ExperimentError("measurements come from files, --follow or --folder: give one of them");
  }
  if (arguments.windows && (arguments.files.empty() || !arguments.at.empty())) {
    throw ExperimentError(
        "--windows is of files, which state its times: leave --folder, --follow and --at out");
  }
  if (!arguments.at.empty() && arguments.files.size() != 1) {
    throw ExperimentError("--at is of one measurement: give one file, or a column of times (tracking.time)");
  }
}

}  // namespace

void track(const TrackArguments& arguments) {
  requireOneSource(arguments);
  setThreads(arguments.threads);
  TrackCommand command(arguments);
  if (!arguments.folder.empty()) {
    command.trackFolder(arguments.folder, arguments.follow);
  } else if (arguments.follow) {
    command.trackStream(std::cin);
  }
  for (const std::string& file : arguments.files) {
    command.trackFile(file);
  }
  command.finish(arguments);
}

}  // namespace twinmap::cli
