#pragma once

#include <cstddef>
#include <string>

#include "framework/base/json/json_fwd.hpp"

namespace twinmap::serve {

/// A measurement as it came.
struct PostedMeasurement {
  std::string text;   ///< a CSV table
  std::string name;   ///< what stands for a file in answers and errors
  std::string at;     ///< its time, ISO 8601 or seconds since 1970; "": by the table, else its number
  std::string trial;  ///< of the experiment; ""
};

/// The twin behind the server. For one thread.
class MeasurementService {
 public:
  virtual ~MeasurementService() = default;

  /// Updates the twin: what `twinmap track` prints of the measurement. Throws ExperimentError where it cannot
  /// be used, another exception where it could not be worked on or written: nothing has changed then.
  virtual Json answer(const PostedMeasurement& posted) = 0;

  /// What was answered until now outlives a loss of power from here on. Throws where it may not, or where the
  /// twin is not what is on disk: it is not to be asked any more then.
  virtual void commit() = 0;

  /// The belief now: "measurements", "parameters" ... of `twinmap track`.
  virtual Json getState() const = 0;

  /// CSV of the newest `most` measurements, filtered and smoothed.
  virtual std::string makeHistory(std::size_t most) const = 0;

  /// HTML without scripts: all of it, drawn, as `twinmap track --page`.
  virtual std::string makePage() const = 0;
};

}  // namespace twinmap::serve
