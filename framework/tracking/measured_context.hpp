#pragma once

#include <vector>

#include "framework/data/measurement/files/table.hpp"
#include "framework/experiment/tracking_spec.hpp"
#include "framework/inference/measurement_reader.hpp"
#include "framework/tracking/track_record.hpp"

namespace twinmap {

/// The time of a measurement, s since 1970: the first value of its column; none where no column is stated.
/// Throws MeasurementError for a column that is missing, or does not begin with a time.
std::optional<double> readTrackTime(const Table& table, const TrackingSpec* tracking);

/// The rows of a table within the window that is inferred from, and `beside` (s) before and behind it. The
/// whole table where it has columns of
/// several lengths, or samples that were reduced. Throws MeasurementError where it has no times.
Table takeWindow(const Table& table, const MeasurementReader& reader, std::optional<double> start,
                 double beside = 0.0);

/// The mean of each condition's column, of the cells that are there; NaN where there are none.
Eigen::VectorXd readConditions(const Table& table, const std::vector<std::string>& conditions);

/// How large and how fast each column moves, and the conditions. Both are logarithms of root mean squares, of
/// the column and of its differences. Columns of times (increasing) and those that do not move have none.
std::vector<Covariate> listCovariates(const Table& table, const std::vector<std::string>& conditions);

}  // namespace twinmap
