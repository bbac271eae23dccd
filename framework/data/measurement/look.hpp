#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {

/// Samples that stand out, and where the first of them is (s; NaN where there is none).
struct FoundSamples {
  Eigen::Index count = 0;
  double first = 0.0;
  std::vector<double> times{};  ///< of all, where each is told
};

/// What a column looks like, without a model.
struct ColumnLook {
  std::string name;
  std::optional<std::string> unit;  ///< as the table states it
  Eigen::Index samples = 0;         ///< that are there
  Eigen::Index missing = 0;         ///< rows without a number
  double least = 0.0, largest = 0.0;
  double step = 0.0;         ///< s, median; of the samples that are there
  double step_spread = 0.0;  ///< largest deviation from it of 9 steps in 10, over it
  FoundSamples gaps;         ///< steps of more than 1.5 median ones
  double longest_gap = 0.0;  ///< s
  bool gaps_are_missing =
      false;                   ///< whether they are where rows have no number, and no such row is elsewhere
  FoundSamples short_steps;    ///< of less than a fifth of those about them: double triggers?
  double shortest_step = 0.0;  ///< s, of these
  FoundSamples spikes;         ///< more than 20 noise standard deviations off their neighbours
  FoundSamples at_least, at_largest;  ///< samples in runs of 3 or more at the extremes
  FoundSamples turns;                 ///< jumps by a whole turn
  double turn = 0.0;                  ///< their size
  double noise = 0.0;                 ///< standard deviation of what is not smooth, at most
  double resolution = 0.0;            ///< smallest difference of two samples, where few values occur; else 0
  bool is_constant = false;
};

struct TableLook {
  std::string source;
  std::string time;  ///< the column of times; "" where they follow from a rate
  bool time_was_guessed = false;
  Eigen::Index rows = 0;
  double first = 0.0, last = 0.0;    ///< s
  std::vector<std::string> remarks;  ///< rows that are not in order
  std::vector<ColumnLook> columns;   ///< without that of the times
  std::vector<SkippedColumn> skipped;
};

/// Looks at all columns of a table, whose missing cells are NaN. Without a column named t or time, and
/// without one that is stated, the first column whose numbers increase holds the times. Throws
/// MeasurementError where no column can.
///
/// Noise: fourth differences of a smooth signal that is sampled often enough vanish, those of white noise of
/// sd s have the sd sqrt(70) s; s is from their median, so that spikes do not count. Of a signal with few
/// samples a period it is too large. A spike is 20 s off the cubic through its four neighbours, further
/// than they are, and comes back within three samples, as a step does not. Samples at an extreme count as
/// clipped in runs of three, but for those at either end of the record, where nothing may move yet, and, of a
/// signal without noise, those that it would not pass by the three samples at either side: flat tops and
/// square waves. O(rows log rows) a column.
TableLook look(const Table& table, const TimeBase& base);

std::string makeLookText(const TableLook& look);
std::string makeLookJson(const TableLook& look);

}  // namespace twinmap
