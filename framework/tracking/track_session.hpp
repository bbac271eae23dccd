#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/json/json_fwd.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/tracking/twin_source.hpp"

namespace twinmap {

struct TrackOptions {
  std::optional<TrackingSpec> tracking{};  ///< none: all parameters walk at unknown rates
  std::vector<std::string>
      use{};  ///< statuses of measurements that update although they do not by themselves
  std::vector<std::string> known{};  ///< "NAME=VALUE" of each input of the set-up
  int lag = 100;                     ///< measurements back that a late one may belong to
  SessionOptions session{};          ///< how each is inferred
};

/// The section `tracking:` of the file `given` if there is one, else of the experiment file itself where it
/// has that, else none. Throws ExperimentError where the given file has none.
std::optional<TrackingSpec> findTracking(const std::filesystem::path& run_or_experiment,
                                         const std::filesystem::path& given);

/// What is known of a measurement besides its table.
struct MeasurementContext {
  std::optional<double> at{};     ///< its time, s since 1970; none: by the table, else its number
  std::optional<double> start{};  ///< as of `infer --start`, s
  std::string trial{};            ///< of an experiment with trials: which it records
};

/// The one twin in time behind `twinmap track` and `twinmap serve`: a belief over the parameters that
/// measurements update, kept in a state file. For one thread; one process at a time has a state file.
class TrackSession {
 public:
  /// Goes on from the state file where there is one, else begins it with the first measurement. The history
  /// is beside it (getHistoryFile). Throws ExperimentError for options that are wrong, std::runtime_error
  /// naming the file for one that is damaged, of another version or of another run, or in use.
  TrackSession(const TwinSource& source, std::filesystem::path state, TrackOptions options);
  ~TrackSession();

  /// Infers the measurement and updates the belief; the answer, which commit() goes before, is that of
  /// `infer --json` with `track` beside. One that was counted is not inferred again: its answer has the
  /// status that is kept. The text is a CSV table as a file has it, and the name stands for the file in
  /// answers and errors. Throws MeasurementError where it cannot be used, ExperimentError for an unknown
  /// trial: nothing has changed then.
  Json update(const std::string& text, const std::string& name, const MeasurementContext& context);
  Json updateFile(const std::filesystem::path& file, const MeasurementContext& context);
  /// Waits until history and state are on the disk with all updates. What was not committed is as if it had
  /// not come. Throws std::runtime_error naming the file.
  void commit();

  /// The belief now: "measurements", "time", "parameters" (mean, sd, lower, upper, unit, rate), "covariance",
  /// "alarms", "forecast".
  Json getState() const;
  /// track.csv: a row per measurement and parameter, filtered and smoothed. O(measurements).
  std::string makeHistory() const;
  /// The page of `track --page` (makeTrackPage()). O(measurements).
  std::string makePage() const;
  std::filesystem::path getHistoryFile() const;
  /// The time that a file states (`tracking.time`); none: it is numbered as it comes. Throws
  /// MeasurementError.
  std::optional<double> readTime(const std::filesystem::path& file, const std::string& trial) const;
  /// The starts of windows every `length` s that a file covers (MeasurementReader::listWindows()).
  std::vector<double> listWindows(const std::filesystem::path& file, const MeasurementContext& context,
                                  double length) const;
  /// Digests of all measurements that were counted, from the history.
  std::vector<std::string> listCounted() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace twinmap
