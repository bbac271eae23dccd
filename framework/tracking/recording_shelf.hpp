#pragma once

#include <deque>
#include <optional>

#include "framework/inference/measurement_reader.hpp"
#include "framework/tracking/track_record.hpp"

namespace twinmap {

/// A measurement's table, or the part of it that is looked at.
struct KeptTable {
  std::string digest;
  double time = 0.0;
  std::optional<double> start{};  ///< time in the table that is 0 of the model, s
  Table table{};
};

/// Tables of the last measurements of a process: 48, and 16 MiB of numbers. Those are more than the
/// measurements before which changes are supposed.
class RecordingShelf {
 public:
  /// Of a table its window, with what is beside it by which signals may be late.
  void add(const MeasurementReader& reader, const Table& table, const TrackRecord& record);

  /// Also of a file that is still the same, read again (columns, missing: as it was). None where it is not at
  /// hand any more. Throws as readTable().
  std::optional<KeptTable> find(const TrackRecord& record, const std::vector<std::string>& columns,
                                MissingCells missing) const;

 private:
  std::deque<KeptTable> tables_;
  std::size_t numbers_ = 0;
};

}  // namespace twinmap
