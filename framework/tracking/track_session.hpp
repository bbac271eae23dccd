#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/json/json_fwd.hpp"
#include "framework/inference/measurement/inference_source.hpp"

namespace twinmap {

struct TrackOptions {
  /// A file with a section `tracking:` (findTracking()); empty: all parameters walk at unknown rates.
  std::filesystem::path tracking{};
  std::vector<std::string>
      use{};  ///< statuses of measurements that update although they do not by themselves
  std::vector<std::string> known{};  ///< "NAME=VALUE" of each input of the set-up
  int lag = 100;                     ///< measurements back that a late one may belong to
  SessionOptions session{};          ///< how each is inferred
};

/// The file to take `tracking:` from: `given` if there is one, else the experiment file itself where it has
/// that section, else none. Throws ExperimentError where the given file has none.
std::filesystem::path findTracking(const std::filesystem::path& run_or_experiment,
                                   const std::filesystem::path& given);

/// What is known of a measurement besides its table.
struct MeasurementContext {
  std::optional<double> at{};     ///< its time, s since 1970; none: by the table, else its number
  std::optional<double> start{};  ///< as of `infer --start`, s
};

/// The one twin in time behind `twinmap track` and `twinmap serve`: a belief over the parameters that
/// measurements update, kept in a state file. For one thread; one process at a time has a state file.
class TrackSession {
 public:
  /// Goes on from the state file where there is one, else begins it with the first measurement. The history
  /// is beside it (getHistoryFile). Throws ExperimentError for options that are wrong, std::runtime_error
  /// naming the file for one that is damaged, of another version or of another run, or in use.
  TrackSession(const InferenceSource& source, std::filesystem::path state, TrackOptions options);
  ~TrackSession();

  /// Infers the measurement and updates the belief; the answer, which commit() goes before, is that of
  /// `infer --json` with `track` beside. text: a CSV table as a file has it. name: what stands for the file
  /// in answers and errors. Throws MeasurementError where it cannot be used: nothing has changed then.
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
  /// Digests of all measurements that were counted, from the history.
  std::vector<std::string> listCounted() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace twinmap
