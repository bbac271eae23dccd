#include "framework/data/measurement/look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/row_order.hpp"
#include "framework/experiment/expression/units.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormalMedian = 0.6744897501960817;  // of |z|

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

/// Places at which a counter fired twice: steps that are short beside the ten about them, which may grow as a
/// wheel slows down.
void findShortSteps(const VectorXd& steps, ColumnLook& look, const VectorXd& times) {
  constexpr double kShort = 0.2;
  constexpr Index kAbout = 5;
  for (Index i = 0; i < steps.size(); ++i) {
    const Index first = std::max<Index>(0, i - kAbout), last = std::min(steps.size() - 1, i + kAbout);
    if (steps[i] > 0.0 && steps[i] < kShort * calcMedian(steps.segment(first, last - first + 1))) {
      look.shortest_step = look.short_steps.count == 0 ? steps[i] : std::min(look.shortest_step, steps[i]);
      add(look.short_steps, times[i]);
    }
  }
}

constexpr double kLongestStep = 1.5;  // in median ones; longer ones are gaps

void lookAtSteps(const VectorXd& times, ColumnLook& look) {
  constexpr double kMost = 0.9;
  look.step = calcMedianStep(times);
  VectorXd steps = times.tail(times.size() - 1) - times.head(times.size() - 1);
  for (Index i = 0; i < steps.size(); ++i) {
    if (steps[i] > kLongestStep * look.step) {
      add(look.gaps, times[i]);
      look.gaps.times.push_back(times[i]);
      look.longest_gap = std::max(look.longest_gap, steps[i]);
    }
  }
  findShortSteps(steps, look, times);
  VectorXd spread = (steps.array() - look.step).abs() / look.step;
  const auto most = static_cast<Index>(kMost * static_cast<double>(spread.size() - 1));
  std::nth_element(spread.data(), spread.data() + most, spread.data() + spread.size());
  look.step_spread = spread[most];
}

/// How far a sample is off the cubic through its four neighbours, of evenly spaced ones.
double calcDeviation(const VectorXd& values, Index i) {
  return values[i] - (4.0 * (values[i - 1] + values[i + 1]) - values[i - 2] - values[i + 2]) / 6.0;
}

/// Whether what jumps about a sample is back within three: a step stays.
bool comesBack(const VectorXd& values, Index i) {
  constexpr Index kWithin = 3;
  constexpr double kBack = 0.5;
  const double before = values[i - 2];
  const double jump = std::max(std::abs(values[i] - before), std::abs(values[i + 1] - before));
  for (Index j = i + 1; j <= std::min(i + kWithin, values.size() - 1); ++j) {
    if (std::abs(values[j] - before) < kBack * jump &&
        (j > i + 1 || std::abs(values[i] - before) >= kBack * jump)) {
      return true;
    }
  }
  return false;
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
    if (deviations[i] > least && deviations[i] > before && deviations[i] >= after &&
        comesBack(values, i + 2)) {
      add(look.spikes, times[i + 2]);
    }
  }
}

/// The smallest difference of two values, and how many differ.
struct Levels {
  double finest = 0.0;
  Index different = 1;
};

Levels findLevels(VectorXd values) {
  constexpr double kRounding = 1e-9;  // of the range: of multiples that were computed
  std::sort(values.begin(), values.end());
  const double least = kRounding * (values[values.size() - 1] - values[0]);
  Levels levels{std::numeric_limits<double>::infinity()};
  for (Index i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    levels.different += difference > least ? 1 : 0;
    levels.finest = difference > least ? std::min(levels.finest, difference) : levels.finest;
  }
  return levels;
}

/// The smallest difference of two values, where few occur.
double findResolution(const VectorXd& values) {
  constexpr double kFew = 0.5;  // of the samples
  const Levels levels = findLevels(values);
  return levels.different > 1 &&
                 static_cast<double>(levels.different) < kFew * static_cast<double>(values.size())
             ? levels.finest
             : 0.0;
}

/// Whether the parabola through the three samples beside a run leads beyond it two samples on: before it, or
/// with step -1 behind it. resolution: of the samples, half of which is weighed by 6, -8, 3 and -1.
bool leadsBeyond(const VectorXd& values, Index beside, Index step, double extreme, double resolution) {
  if (beside - 2 * step < 0 || beside - 2 * step >= values.size()) {
    return false;
  }
  constexpr double kRounding = 0.5 * (6.0 + 8.0 + 3.0 + 1.0);
  const double v1 = values[beside], v2 = values[beside - step], v3 = values[beside - 2 * step];
  const double away = extreme - v1, led = 6.0 * v1 - 8.0 * v2 + 3.0 * v3 - extreme;
  return away * led > 0.0 && std::abs(led) > kRounding * resolution;
}

/// Samples at an extreme in runs of three or more, but for those at either end of the record, and for those
/// that a sensor of this resolution shows where the signal turns. Samples with noise are never the same;
/// without it they are at the top of a swing and in a square wave too.
FoundSamples findClipped(const VectorXd& times, const VectorXd& values, double extreme,
                         const ColumnLook& look) {
  const double resolution = look.resolution;
  const double finest = findLevels(values).finest;
  const bool is_noisy = look.noise > 3.0 * finest;
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
    const bool is_run = end - i >= kRun && i > 0 && end < values.size() && (leaves(i - 1) || leaves(end));
    if (is_run && (is_noisy || leadsBeyond(values, i - 1, 1, extreme, finest) ||
                   leadsBeyond(values, end, -1, extreme, finest))) {
      found.first = found.count == 0 ? times[i] : found.first;
      found.count += end - i;
    }
    i = std::max(end, i + 1);
  }
  return found;
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

/// Whether gaps and rows without a number are the same: each gap holds such rows, and they are in gaps.
bool areInGaps(const VectorXd& times, const std::vector<Index>& there, const ColumnLook& look) {
  Index held = 0, holding = 0;
  for (std::size_t k = 1; k < there.size(); ++k) {
    const Index between = there[k] - there[k - 1] - 1;
    const double step = times[there[k]] - times[there[k - 1]];
    if (between > 0 && step > kLongestStep * look.step) {
      held += between;
      ++holding;
    }
  }
  return holding == look.gaps.count && held == look.missing;
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
  look.gaps.first = look.short_steps.first = look.spikes.first = look.at_least.first = look.at_largest.first =
      look.turns.first = kNowhere;
  if (values.size() < 2) {
    return look;
  }
  look.least = values.minCoeff();
  look.largest = values.maxCoeff();
  look.is_constant = look.least == look.largest;
  lookAtSteps(at, look);
  look.gaps_are_missing = look.missing > 0 && areInGaps(times, there, look);
  if (!look.is_constant) {
    look.resolution = findResolution(values);
    lookAtNoise(at, lookAtTurns(at, values, look), look);
    look.at_least = findClipped(at, values, look.least, look);
    look.at_largest = findClipped(at, values, look.largest, look);
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
