#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/data/noise/noise_estimate.hpp"

namespace twinmap {

/// A column whose noise is estimated.
struct NoiseColumn {
  std::string name;   ///< as it is shown: the column's, or the output's
  ColumnSpec column;  ///< where it stands
  std::string unit;   ///< to convert to; "": as it stands
};

/// The noise of a column.
struct SignalNoise {
  std::string name, unit;
  Eigen::Index samples = 0;
  std::optional<double> sample_time;  ///< s; unknown without times
  NoiseEstimate noise;
};

/// What is asked of a table of measurements.
struct NoiseQuestion {
  TimeBase base;
  std::optional<std::array<double, 2>> window;  ///< s; all rows without one
  std::vector<NoiseColumn> columns;             ///< empty: all but that of the times
};

/// The noise of columns within a window: of its longest stretch where cells (NaN) are missing. Where all
/// columns are asked for, those that have no noise (constant, a straight line) or are no numbers are left
/// out, unless none remains. Throws MeasurementError for a missing column, a window without times, fewer than
/// 20 samples, steps that differ by more than 50 %.
std::vector<SignalNoise> estimateNoise(const Table& table, const NoiseQuestion& question);

/// For people; for programs; and as the key `noise` of an experiment file.
std::string makeNoiseTable(const std::vector<SignalNoise>& signals);
std::string makeNoiseJson(const std::vector<SignalNoise>& signals, const std::string& source);
std::string makeNoiseYaml(const std::vector<SignalNoise>& signals);

}  // namespace twinmap
