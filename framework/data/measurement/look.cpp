#include "framework/data/measurement/look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/row_order.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormalMedian = 0.6744897501960817;  // of |z|

double calcMedian(VectorXd values) {
  double* middle = values.data() + values.size() / 2;
  std::nth_element(values.data(), middle, values.data() + values.size());
  return *middle;
}

bool increases(const VectorXd& values) {
  return values.size() > 1 && values.allFinite() &&
         (values.tail(values.size() - 1).array() > values.head(values.size() - 1).array()).all();
}

/// "ms" of "tempo_ms".
std::optional<std::string> guessUnit(const std::string& name) {
  const std::size_t end = name.rfind('_');
  for (const char* unit : {"s", "ms", "us", "ns"}) {
    if (end != std::string::npos && name.substr(end + 1) == unit) {
      return unit;
    }
  }
  return std::nullopt;
}

/// The base, with a column of times where it names none and the table has none named t or time.
TimeBase findTimes(const Table& table, const TimeBase& base, TableLook& look) {
  if (base.sample_rate) {
    return base;
  }
  for (const std::string& name : listTimeColumns(base)) {
    if (findColumn(table, name) != nullptr) {
      look.time = name;
      return base;
    }
  }
  for (const Column& column : table.columns) {
    if (!base.time && increases(column.values)) {
      look.time = column.name;
      look.time_was_guessed = true;
      return {ColumnSpec{column.name, column.unit ? column.unit : guessUnit(column.name), {}}, {}, 0.0};
    }
  }
  throw MeasurementError(table.source +
                         ": no column can hold the times: none is named t or time, and none increases; give "
                         "--time or --rate");
}

void add(FoundSamples& found, double time) {
  found.first = found.count == 0 ? time : found.first;
  ++found.count;
}

void lookAtSteps(const VectorXd& times, ColumnLook& look) {
  constexpr double kLongest = 1.5, kMost = 0.9;
  look.step = calcMedianStep(times);
  VectorXd steps = times.tail(times.size() - 1) - times.head(times.size() - 1);
  for (Index i = 0; i < steps.size(); ++i) {
    if (steps[i] > kLongest * look.step) {
      add(look.gaps, times[i]);
      look.longest_gap = std::max(look.longest_gap, steps[i]);
    }
  }
  VectorXd spread = (steps.array() - look.step).abs() / look.step;
  const auto most = static_cast<Index>(kMost * static_cast<double>(spread.size() - 1));
  std::nth_element(spread.data(), spread.data() + most, spread.data() + spread.size());
  look.step_spread = spread[most];
}

/// How far a sample is off the cubic through its four neighbours, of evenly spaced ones.
double calcDeviation(const VectorXd& values, Index i) {
  return values[i] - (4.0 * (values[i - 1] + values[i + 1]) - values[i - 2] - values[i + 2]) / 6.0;
}

void lookAtNoise(const VectorXd& times, const VectorXd& values, ColumnLook& look) {
  constexpr Index kLeast = 16;
  constexpr double kSpike = 20.0, kLeastOfRange = 1e-3;  // a computed signal has no noise to compare with
  const Index count = values.size() - 4;
  if (count < kLeast) {
    return;
  }
  // a fourth difference is 6 deviations
  const VectorXd deviations =
      VectorXd::NullaryExpr(count, [&](Index i) { return std::abs(calcDeviation(values, i + 2)); });
  look.noise = 6.0 * calcMedian(deviations) / (kNormalMedian * std::sqrt(70.0));
  const double least =
      std::max(kSpike * std::max(look.noise, look.resolution), kLeastOfRange * (look.largest - look.least));
  for (Index i = 0; i < count; ++i) {
    const double before = i > 0 ? deviations[i - 1] : 0.0, after = i + 1 < count ? deviations[i + 1] : 0.0;
    if (deviations[i] > least && deviations[i] > before && deviations[i] >= after) {
      add(look.spikes, times[i + 2]);
    }
  }
}

/// Samples at an extreme in runs of three or more, but for those at either end of the record, and for those
/// that a sensor of this resolution shows where the signal turns.
FoundSamples findClipped(const VectorXd& times, const VectorXd& values, double extreme, double resolution) {
  constexpr Index kRun = 3;
  constexpr double kSlack = 1e-9, kStep = 1.5;
  const double slack = kSlack * (values.maxCoeff() - values.minCoeff());
  const auto leaves = [&](Index row) { return std::abs(values[row] - extreme) > kStep * resolution; };
  FoundSamples found{0, kNowhere};
  for (Index i = 0; i < values.size();) {
    Index end = i;
    while (end < values.size() && std::abs(values[end] - extreme) <= slack) {
      ++end;
    }
    if (end - i >= kRun && i > 0 && end < values.size() && (leaves(i - 1) || leaves(end))) {
      found.first = found.count == 0 ? times[i] : found.first;
      found.count += end - i;
    }
    i = std::max(end, i + 1);
  }
  return found;
}

/// The smallest difference of two values, where few occur.
double findResolution(VectorXd values) {
  constexpr double kFew = 0.5;  // of the samples
  std::sort(values.begin(), values.end());
  double smallest = std::numeric_limits<double>::infinity();
  Index different = 1;
  for (Index i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    different += difference > 0.0 ? 1 : 0;
    smallest = difference > 0.0 ? std::min(smallest, difference) : smallest;
  }
  return different > 1 && static_cast<double>(different) < kFew * static_cast<double>(values.size())
             ? smallest
             : 0.0;
}

/// Without a unit a signal of the range of a turn may be an angle in rad or degrees. Returns the values,
/// continued over turns.
VectorXd lookAtTurns(const VectorXd& times, const VectorXd& values, ColumnLook& look) {
  constexpr double kTwoPi = 6.283185307179586, kDegrees = 360.0, kWider = 1.1;
  std::vector<double> turns{kTwoPi, kDegrees};
  if (const auto turn = look.unit ? findWholeTurn(*look.unit) : std::nullopt) {
    turns = {*turn};
  }
  for (const double turn : turns) {
    const bool may_wrap = look.largest - look.least < kWider * turn;
    for (const Index row : may_wrap ? findTurnJumps(values, turn) : std::vector<Index>()) {
      add(look.turns, times[row]);
      look.turn = turn;
    }
    if (look.turns.count > 0) {
      return unwrap(times, values, turn);
    }
  }
  return values;
}

ColumnLook lookAt(const Column& column, const VectorXd& times) {
  ColumnLook look;
  look.name = column.name;
  look.unit = column.unit;
  std::vector<Index> there;
  for (Index i = 0; i < times.size(); ++i) {
    if (std::isfinite(column.values[i])) {
      there.push_back(i);
    }
  }
  const VectorXd at = times(there), values = column.values(there);
  look.samples = values.size();
  look.missing = times.size() - look.samples;
  look.gaps.first = look.spikes.first = look.at_least.first = look.at_largest.first = look.turns.first =
      kNowhere;
  if (values.size() < 2) {
    return look;
  }
  look.least = values.minCoeff();
  look.largest = values.maxCoeff();
  look.is_constant = look.least == look.largest;
  lookAtSteps(at, look);
  if (!look.is_constant) {
    look.resolution = findResolution(values);
    lookAtNoise(at, lookAtTurns(at, values, look), look);
    look.at_least = findClipped(at, values, look.least, look.resolution);
    look.at_largest = findClipped(at, values, look.largest, look.resolution);
  }
  return look;
}

Index countRows(const Table& table) {
  Index rows = 0;
  for (const Column& column : table.columns) {
    rows = std::max(rows, column.values.size());
  }
  return rows;
}

}  // namespace

TableLook look(const Table& table, const TimeBase& base) {
  TableLook looked;
  looked.source = table.source;
  looked.skipped = table.skipped;
  const TimeBase known = findTimes(table, base, looked);
  for (const Column& column : table.columns) {
    if (column.name == looked.time) {
      continue;
    }
    if (column.values.size() == 1 && countRows(table) > 1) {  // a setting beside the recording
      looked.skipped.push_back(
          {column.name, fmt::format("{}: column '{}' is a single number, {}", table.source, column.name,
                                    toText(column.values[0]))});
      continue;
    }
    const VectorXd times = readUnorderedTimes(table, known, column.values.size());
    requireLength(table, column, times.size());
    RowOrder order = sortRows(times);
    const VectorXd sorted = times(order.rows);
    if (looked.columns.empty() && sorted.size() > 0) {
      looked.rows = times.size();
      looked.first = sorted[0];
      looked.last = sorted[sorted.size() - 1];
      looked.remarks = std::move(order.remarks);
    }
    looked.columns.push_back(lookAt({column.name, column.unit, column.values(order.rows)}, sorted));
  }
  return looked;
}

}  // namespace twinmap
