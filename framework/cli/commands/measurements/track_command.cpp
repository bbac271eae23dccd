#include <fmt/core.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/digest.hpp"
#include "framework/base/json/json.hpp"
#include "framework/cli/commands/measurements/track_options.hpp"
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
        context_{readTime(arguments.at), arguments.start} {}

  void trackFile(const fs::path& file) {
    track(file.string(), [&] { return session_.updateFile(file, context_); });
  }

  /// The files of a folder that were not tracked yet, in the order of their names.
  void trackFolder(const fs::path& folder) {
    std::set<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        files.insert(entry.path());
      }
    }
    const std::vector<std::string> list = session_.listCounted();
    const std::set<std::string> counted(list.begin(), list.end());
    for (const fs::path& file : files) {
      if (counted.count(toHex(calcFileDigest(file))) == 0) {
        trackFile(file);
      }
    }
  }

  void trackStream(std::istream& stream) {
    MeasurementStream measurements(stream);
    std::string text;
    for (int i = 1; measurements.next(text); ++i) {
      const std::string name = "measurement " + std::to_string(i);
      track(name, [&] { return session_.update(text, name, context_); });
      std::cout.flush();
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
  template <class Update>
  void track(const std::string& name, const Update& update) {
    ++count_;
    try {
      WaitingLine waiting("track " + name);
      const Json answer = update();
      session_.commit();
      waiting.clear();
      std::cout << formatJson(answer) << '\n';
    } catch (const std::exception& error) {
      ++errors_;
      std::cout << makeErrorJson(name, context_.start.value_or(0.0), error.what()) << '\n';
      std::cout.flush();
      std::cerr << "twinmap: error: " << error.what() << "\n";
    }
  }

  const InferenceSource source_;
  TrackSession session_;
  const MeasurementContext context_;
  int count_ = 0, errors_ = 0;
};

void requireOneSource(const TrackArguments& arguments) {
  const int given =
      (arguments.files.empty() ? 0 : 1) + (arguments.follow ? 1 : 0) + (arguments.folder.empty() ? 0 : 1);
  if (given > 1) {
    throw ExperimentError("measurements come from files, --follow or --folder: give one of them");
  }
  if (!arguments.at.empty() && (arguments.files.size() != 1 || given != 1)) {
    throw ExperimentError("--at is of one measurement: give one file, or a column of times (tracking.time)");
  }
}

}  // namespace

void track(const TrackArguments& arguments) {
  requireOneSource(arguments);
  setThreads(arguments.threads);
  TrackCommand command(arguments);
  if (arguments.follow) {
    command.trackStream(std::cin);
  } else if (!arguments.folder.empty()) {
    command.trackFolder(arguments.folder);
  }
  for (const std::string& file : arguments.files) {
    command.trackFile(file);
  }
  command.finish(arguments);
}

}  // namespace twinmap::cli
