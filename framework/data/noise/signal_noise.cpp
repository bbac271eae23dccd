#include "framework/data/noise/signal_noise.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The times of the table, if it has any.
std::optional<VectorXd> findTimes(const Table& table, const TimeBase& base, Index rows) {
  const std::vector<std::string> names = listTimeColumns(base);
  const bool none = !base.time && !base.sample_rate &&
                    std::none_of(names.begin(), names.end(),
                                 [&](const auto& name) { return findColumn(table, name) != nullptr; });
  return none ? std::nullopt : std::make_optional(readTimes(table, base, rows));
}

/// The rows within the window, both ends included.
RowRange findWindow(const Table& table, const NoiseQuestion& question, const std::optional<VectorXd>& times,
                    Index rows) {
  if (!question.window) {
    return {0, rows};
  }
  if (!times) {
    throw MeasurementError(table.source +
                           ": has no column named t or time, which a window needs; an experiment "
                           "file may name one, or give measurement.sample_rate");
  }
  const double* begin = times->data();
  const double* end = begin + times->size();
  const Index first = std::lower_bound(begin, end, (*question.window)[0]) - begin;
  return {first, std::max<Index>(0, std::upper_bound(begin, end, (*question.window)[1]) - begin - first)};
}

/// The longest stretch of a window in which no value is missing.
RowRange findLongestStretch(const VectorXd& values, const RowRange& window) {
  RowRange longest{window.first, 0};
  Index first = window.first;
  for (Index i = window.first; i < window.first + window.count; ++i) {
    first = std::isfinite(values[i]) ? first : i + 1;
    if (i + 1 - first > longest.count) {
      longest = {first, i + 1 - first};
    }
  }
  return longest;
}

/// The step of the times, which are nearly equidistant.
double calcStep(const Table& table, const VectorXd& times) {
  constexpr double kLongest = 1.5;
  const double step = calcMedianStep(times);
  for (Index i = 0; i + 1 < times.size(); ++i) {
    if (times[i + 1] - times[i] > kLongest * step) {
      throw MeasurementError(table.source + ": has a gap of " + toShortText(times[i + 1] - times[i], 4) +
                             " s after row " + std::to_string(i + 1) + " (t = " + toText(times[i]) +
                             " s); choose a window without");
    }
  }
  return step;
}

std::vector<NoiseColumn> listAll(const Table& table, const TimeBase& base) {
  const std::vector<std::string> times = listTimeColumns(base);
  std::vector<NoiseColumn> columns;
  for (const Column& column : table.columns) {
    if (std::find(times.begin(), times.end(), column.name) == times.end()) {
      columns.push_back({column.name, {column.name, {}, {}}, ""});
    }
  }
  return columns;
}

SignalNoise estimateOne(const Table& table, const NoiseQuestion& question, const NoiseColumn& wanted) {
  const Column& column = getColumn(table, wanted.column.name);
  const std::optional<VectorXd> times = findTimes(table, question.base, column.values.size());
  if (times) {
    requireLength(table, column, times->size());
  }
  const RowRange rows =
      findLongestStretch(column.values, findWindow(table, question, times, column.values.size()));
  const std::string unit = wanted.unit.empty() ? column.unit.value_or("") : wanted.unit;
  SignalNoise signal{wanted.name, unit, rows.count, {}, {}};
  const VectorXd values = readValues(table, wanted.column, wanted.unit, rows.first, rows.count);
  try {
    signal.noise = estimateNoise(values);
  } catch (const std::invalid_argument& error) {
    throw MeasurementError(table.source + ": column '" + column.name + "' " + error.what() +
                           (question.window ? " in the window" : ""));
  }
  if (times) {
    signal.sample_time = calcStep(table, times->segment(rows.first, rows.count));
  }
  return signal;
}

}  // namespace

std::vector<SignalNoise> estimateNoise(const Table& table, const NoiseQuestion& question) {
  std::vector<SignalNoise> signals;
  for (const NoiseColumn& column : question.columns) {
    signals.push_back(estimateOne(table, question, column));
  }
  std::string problem = table.source + ": has no column of measured values";
  for (const NoiseColumn& column :
       question.columns.empty() ? listAll(table, question.base) : std::vector<NoiseColumn>{}) {
    try {
      signals.push_back(estimateOne(table, question, column));
    } catch (const MeasurementError& error) {
      problem = error.what();
    }
  }
  if (signals.empty()) {
    throw MeasurementError(problem);
  }
  return signals;
}

}  // namespace twinmap
