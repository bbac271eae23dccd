#include "framework/tracking/measured_context.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd takeFinite(const VectorXd& values) {
  VectorXd finite(values.size());
  Index count = 0;
  for (const double value : values) {
    if (std::isfinite(value)) {
      finite[count++] = value;
    }
  }
  return finite.head(count);
}

/// 0 of nothing that moves.
double calcRootMeanSquare(const VectorXd& values) {
  return values.size() > 1 ? std::sqrt((values.array() - values.mean()).square().mean()) : 0.0;
}

VectorXd calcDifferences(const VectorXd& values) {
  return values.size() > 1 ? VectorXd(values.tail(values.size() - 1) - values.head(values.size() - 1))
                           : VectorXd();
}

}  // namespace

std::optional<double> readTrackTime(const Table& table, const TrackingSpec* tracking) {
  if (tracking == nullptr || !tracking->time.column) {
    return {};
  }
  const ColumnSpec& wanted = *tracking->time.column;
  const double time = readValues(table, wanted, wanted.unit ? "s" : "", 0, 1)[0];
  if (!std::isfinite(time)) {
    throw MeasurementError(table.source + ": column '" + wanted.name +
                           "' does not begin with a time: a date and time, or seconds since 1970");
  }
  return time;
}

Table takeWindow(const Table& table, const MeasurementReader& reader, std::optional<double> start,
                 double beside) {
  const VectorXd& times = reader.getLayout().times;
  const Index rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  const bool is_even = std::all_of(table.columns.begin(), table.columns.end(),
                                   [&](const Column& column) { return column.values.size() == rows; });
  if (times.size() == 0 || reader.findReduction() != nullptr || !is_even) {
    return table;
  }
  const double first = reader.getStart(table, start), last = first + times[times.size() - 1];
  const double slack = 1e-6 * (last - first);  // as times are compared when they are read
  const VectorXd measured =
      readUnorderedTimes(table, makeTimeBase(reader.getExperiment().measurement, 0.0), rows);
  std::vector<Index> within;
  for (Index i = 0; i < measured.size(); ++i) {
    if (measured[i] >= first - beside - slack && measured[i] <= last + beside + slack) {
      within.push_back(i);
    }
  }
  Table window{table.source, {}, {}};
  for (const Column& column : table.columns) {
    window.columns.push_back({column.name, column.unit, column.values(within)});
  }
  return window;
}

VectorXd readConditions(const Table& table, const std::vector<std::string>& conditions) {
  VectorXd means(static_cast<Index>(conditions.size()));
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    const Column* column = findColumn(table, conditions[c]);
    const VectorXd values = column == nullptr ? VectorXd() : takeFinite(column->values);
    means[static_cast<Index>(c)] =
        values.size() > 0 ? values.mean() : std::numeric_limits<double>::quiet_NaN();
  }
  return means;
}

std::vector<Covariate> listCovariates(const Table& table, const std::vector<std::string>& conditions) {
  std::vector<Covariate> covariates;
  const VectorXd means = readConditions(table, conditions);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    if (std::isfinite(means[static_cast<Index>(c)])) {
      covariates.push_back({conditions[c], means[static_cast<Index>(c)]});
    }
  }
  for (const Column& column : table.columns) {
    const VectorXd values = takeFinite(column.values);
    const VectorXd differences = calcDifferences(values);
    const bool is_time = differences.size() > 0 && differences.minCoeff() > 0.0;
    const bool is_condition =
        std::find(conditions.begin(), conditions.end(), column.name) != conditions.end();
    const double size = calcRootMeanSquare(values), speed = calcRootMeanSquare(differences);
    if (is_time || is_condition || !(size > 0.0 && speed > 0.0)) {
      continue;
    }
    covariates.push_back({"the amplitude of " + column.name, std::log(size)});
    covariates.push_back({"the speed of " + column.name, std::log(speed)});
  }
  return covariates;
}

}  // namespace twinmap
