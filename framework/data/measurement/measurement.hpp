#pragma once

#include "framework/data/measurement/table.hpp"
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

/// The names of all columns that are read for these outputs, for readTable().
std::vector<std::string> listColumns(const MeasurementSpec& spec, const std::vector<std::string>& outputs);

/// The outputs of the layout from the columns of a table, converted to the layout's units; only the rows that
/// its times need, and a few beside. Throws MeasurementError for a missing column, columns of different
/// length, a unit that does not convert, times that do not increase. O(rows of the table) for the times,
/// O(rows needed) for the outputs.
Measurement readMeasurement(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout);

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
