#pragma once

#include "framework/data/measurement/files/table.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// The outputs of a model as they were measured, at the times of the measurement.
struct Measurement {
  std::string source;
  Eigen::VectorXd times;                  ///< s; 0 is the model's; strictly increasing
  std::vector<std::string> column_names;  ///< of each output of the layout, for messages
  Eigen::MatrixXd values;                 ///< times x outputs, in the layout's units
};

/// Where an output stands: as listed, or in a column of its own name.
ColumnSpec findColumnSpec(const MeasurementSpec& spec, const std::string& output);

/// The clock of an output's column: its own, or that of the measurement; `start`: the time in the table (s)
/// at which the model's time is 0, a delay of the column's clock not counted.
TimeBase makeTimeBase(const MeasurementSpec& spec, const std::string& output, double start);
/// That of the measurement.
TimeBase makeTimeBase(const MeasurementSpec& spec, double start);

/// The file that holds an output's column, beside the measurement `source`; none where that does.
std::optional<std::filesystem::path> findOwnFile(const MeasurementSpec& spec, const std::string& output,
                                                 const std::string& source);

/// Whether any column has a file, times or a delay of its own.
bool hasOwnClocks(const MeasurementSpec& spec);

/// A whole turn of an output in its unit, where the measurement says that it wraps or its unit is one of
/// angles: that of its `range`, else of its unit; none of others.
std::optional<double> findTurn(const MeasurementSpec& spec, const std::string& output,
                               const std::string& unit);
/// The range of a sensor that clips; none of an output that wraps.
std::optional<Bounds> findRange(const MeasurementSpec& spec, const std::string& output);
/// 1 for a value at the upper limit of a range, within 1e-6 of its width, -1 at the lower one, else 0.
double findSide(const std::optional<Bounds>& range, double value);
bool isUnwrapped(const MeasurementSpec& spec, const std::string& output);

/// Outputs of a table that jump by a whole turn though the measurement does not say that they wrap
/// (findTurnJumps), a sentence each that says what to do. Of columns that the table has.
std::vector<std::string> describeJumps(const Table& table, const MeasurementSpec& spec,
                                       const ResponseLayout& layout);

/// Columns of times and outputs whose names end in a unit that is not read (describeUnreadUnit), a sentence
/// each. Of columns that the table has.
std::vector<std::string> describeUnreadUnits(const Table& table, const MeasurementSpec& spec,
                                             const ResponseLayout& layout);

/// The names of all columns that are read for these outputs and for the start, for readTable().
std::vector<std::string> listColumns(const MeasurementSpec& spec, const std::vector<std::string>& outputs);

/// An output in its unit at rows from `first` on, whose times these are, continued where it wraps. Throws
/// MeasurementError as readValues() does.
Eigen::VectorXd readOutput(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                           std::size_t output, const Eigen::VectorXd& times, Eigen::Index first);

/// Whether any of the features is made of an output.
bool usesOutput(const std::vector<FeatureSpec>& features, const std::string& output);

/// The outputs of the layout from the columns of a table with one clock, whose time `start` (s) is the
/// model's 0, converted to the layout's units; only the rows that its times need, and a few beside; outputs
/// that wrap continued over turns (unwrap). Throws MeasurementError for a missing column, columns of
/// different length, a unit that does not convert, times that do not increase. O(rows of the table) for the
/// times, O(rows needed) for the outputs. features: what the outputs are for; of none are NaN, and need no
/// column. Empty: all are needed.
Measurement readMeasurement(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                            double start, const std::vector<FeatureSpec>& features = {});

/// Throws MeasurementError for a sample between the layout's first and last time at a limit of its sensor's
/// range: for what cannot use clipped samples.
void requireUnclipped(const Measurement& measurement, const MeasurementSpec& spec,
                      const ResponseLayout& layout);

/// A response at the times of the layout (its rows), as features are extracted from: a measured value where
/// the times agree within 1e-6 of the median step, else the cubic through the four nearest samples (Lagrange;
/// two on either side, except at the ends). `interval`: the smallest interval (s) at which features sample
/// the outputs; default: the smallest difference of the layout's times. Throws MeasurementError
/// - where the measurement does not cover the layout's times,
/// - where it would be interpolated over a step of more than 1.5 median steps (a gap), or with a median step
///   more than 1 % above `interval`,
/// - for an output that is the same at all needed times, if there are at least 4: a dead sensor,
/// - for a layout with modes, which no time series gives.
Eigen::VectorXd resample(const Measurement& measurement, const ResponseLayout& layout,
                         std::optional<double> interval = {});

}  // namespace twinmap
