#include "framework/data/measurement/trained_excitation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "framework/data/measurement/lagrange.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/row_order.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A sensor of forces is calibrated to 1 % or better. More would be passed on to the parameters: where mass,
/// damping and stiffness are all sought, the response determines them up to the scale of the excitation.
constexpr double kLargestScale = 0.02;
/// Not noise alone, which is 1 % or so: a window of a periodic excitation begins with what came before it
/// (4.5 % of Silverbox' first period). Another excitation of the same strength differs by 140 %, the same one
/// a tenth of a period late by 60 %. What is left is for the test of trust to judge.
constexpr double kLargestDifference = 0.1;

/// A signal, or a part of it; the time that is 0 of the model is 0.
struct SampledSignal {
  VectorXd times, values;
};

/// Two signals at common times.
struct Pair {
  VectorXd times, trained, measured;
};

VectorXd selectTimes(const VectorXd& times, double from, double to) {
  const double *begin = times.data(), *end = begin + times.size();
  const double* first = std::lower_bound(begin, end, from);
  const double* last = std::upper_bound(first, end, to);
  return Eigen::Map<const VectorXd>(first, last - first);
}

/// At times that the signal covers: its sample that was taken then, or the cubic through the four nearest.
VectorXd interpolate(const SampledSignal& signal, const VectorXd& times) {
  const double same = kSameTime * calcMedianStep(signal.times);
  const double* begin = signal.times.data();
  const Index size = signal.times.size();
  const int points = static_cast<int>(std::min<Index>(size, InterpolationWeights::kPoints));
  return times.unaryExpr([&](double t) {
    const Index found = std::lower_bound(begin, begin + size, t - same) - begin;
    const Index next = std::min(found, size - 1);
    const bool taken = std::abs(signal.times[next] - t) <= same;
    const Index first = taken ? next : std::clamp<Index>(next - points / 2, 0, size - points);
    return apply(makeLagrange(signal.times, first, taken ? 1 : points, t), signal.values);
  });
}

/// Times that lie in no gap of a signal, where what it was is not known.
VectorXd leaveOutGaps(const SampledSignal& signal, const VectorXd& times) {
  constexpr double kLongest = 1.5;
  const double step = calcMedianStep(signal.times), same = kSameTime * step;
  std::vector<double> known;
  for (const double t : times) {
    const auto next = std::lower_bound(signal.times.begin(), signal.times.end(), t - same);
    const bool is_sample = next != signal.times.end() && *next <= t + same;
    const bool is_between = next != signal.times.begin() && next != signal.times.end();
    if (is_sample || !is_between || *next - *std::prev(next) <= kLongest * step) {
      known.push_back(t);
    }
  }
  return Eigen::Map<const VectorXd>(known.data(), static_cast<Index>(known.size()));
}

/// At the times of the one with the longer steps, because interpolating the other loses less.
Pair bringTogether(const SampledSignal& trained, const SampledSignal& measured) {
  constexpr double kSameStep = 1.01;
  const double step = calcMedianStep(trained.times), slack = kSameTime * step;
  const bool finer = calcMedianStep(measured.times) <= kSameStep * step;
  const Index last_trained = trained.times.size() - 1, last_measured = measured.times.size() - 1;
  const double from = std::max({0.0, trained.times[0], measured.times[0]}) - slack;
  const double to = std::min(trained.times[last_trained], measured.times[last_measured]) + slack;
  const VectorXd times = leaveOutGaps(
      measured, leaveOutGaps(trained, selectTimes(finer ? trained.times : measured.times, from, to)));
  return {times, interpolate(trained, times), interpolate(measured, times)};
}

SampledSignal takeTrained(const TableSpec& table, double duration) {
  const auto size = static_cast<Index>(table.times.size());
  const Eigen::Map<const VectorXd> times(table.times.data(), size), values(table.values.data(), size);
  const RowRange rows = findRows(times, 0.0, duration, 0);
  return {times.segment(rows.first, rows.count), values.segment(rows.first, rows.count)};
}

SampledSignal readMeasured(const Table& table, const ColumnSpec& column, const MeasurementSpec& spec,
                           const std::string& unit, double start) {
  const Column& found = getColumn(table, column.name);
  const TimeBase base = makeTimeBase(spec, start);
  const VectorXd times = readUnorderedTimes(table, base, found.values.size());
  requireClock(table, base, times);
  requireLength(table, found, times.size());
  const VectorXd values = readValues(table, column, unit, 0, times.size());
  std::vector<Index> rows = sortRows(times).rows;
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](Index row) { return std::isnan(values[row]); }),
             rows.end());
  return {times(rows), values(rows)};
}

/// Whether the table is all that the signal consists of.
bool isWholeSignal(const SignalSpec& signal) {
  return signal.tables.size() == 1 && signal.pulses.empty() && signal.sines.empty() &&
         signal.chirps.empty() && signal.multisines.empty();
}

/// The column that holds it; nullopt where the table has none.
std::optional<ColumnSpec> findSignalColumn(const Table& table, const SignalSpec& signal,
                                           const MeasuredSignalSpec& measured) {
  const ColumnSpec column = parseColumn(measured.column.text, measured.column.where);
  if (findColumn(table, column.name) != nullptr) {
    return column;
  }
  if (isWholeSignal(signal) && findColumn(table, signal.name.text) != nullptr) {
    return ColumnSpec{signal.name.text, {}, {}};
  }
  return std::nullopt;
}

void requireSame(const Pair& pair, const SignalSpec& signal, const std::string& source,
                 const std::string& column, double start) {
  const VectorXd difference = pair.measured - pair.trained;
  const double scale = difference.dot(pair.trained), strength = pair.trained.squaredNorm();
  const double allowed = kLargestDifference * kLargestDifference * strength;
  if (std::abs(scale) <= kLargestScale * strength && difference.squaredNorm() <= allowed) {
    return;
  }
  Index worst = 0;
  difference.cwiseAbs().maxCoeff(&worst);
  throw MeasurementError(fmt::format(
      "{}: column '{}' is not the excitation '{}' that the map was trained on: it differs by {:.3g} % (root "
      "mean square; at most {:.0f} %), its scale is {:.4g} (1 within {:.0f} %), and at {:.6g} s it is {:.4g} "
      "{} instead of {:.4g} {}; give the start of a window with that excitation (--start), or train a map on "
      "this one",
      source, column, signal.name.text, 100.0 * std::sqrt(difference.squaredNorm() / strength),
      100.0 * kLargestDifference, 1.0 + scale / strength, 100.0 * kLargestScale, pair.times[worst] + start,
      pair.measured[worst], signal.unit, pair.trained[worst], signal.unit));
}

/// The signal of a file of its own, where the start of a recording without its column has moved and the file
/// is there.
void compareOwnFile(const ExperimentSpec& experiment, const SignalSpec& signal, const TableSpec& trained,
                    const Table& recording, double start) {
  if (!std::filesystem::exists(trained.measured->file.text)) {
    return;
  }
  ExperimentSpec moved = experiment;
  moved.model.excitation = {signal};
  moved.model.excitation.front().tables = {trained};
  if (!followMeasuredSignals(moved, recording, start, 0.0)) {
    return;
  }
  const double duration = experiment.model.simulation.duration;
  const SampledSignal now = takeTrained(moved.model.excitation.front().tables.front(), duration);
  const Pair pair = bringTogether(takeTrained(trained, duration), now);
  if (pair.times.size() > 0) {
    requireSame(pair, signal, trained.measured->file.text, trained.measured->column.text, start);
  }
}

void compare(const ExperimentSpec& experiment, const SignalSpec& signal, const TableSpec& trained,
             const Table& table, double start) {
  const std::optional<ColumnSpec> column = findSignalColumn(table, signal, *trained.measured);
  if (!column) {
    compareOwnFile(experiment, signal, trained, table, start);
    return;
  }
  const SampledSignal measured = readMeasured(table, *column, experiment.measurement, signal.unit, start);
  const SampledSignal taken = takeTrained(trained, experiment.model.simulation.duration);
  if (measured.times.size() < 2 || taken.times.size() < 2) {
    return;
  }
  const Pair pair = bringTogether(taken, measured);
  if (pair.times.size() > 0) {
    requireSame(pair, signal, table.source, column->name, start);
  }
}

}  // namespace

std::vector<std::string> listExcitationColumns(const ExperimentSpec& experiment) {
  std::vector<std::string> names;
  for (const SignalSpec& signal : experiment.model.excitation) {
    for (const TableSpec& table : signal.tables) {
      if (table.measured) {
        names.push_back(parseColumn(table.measured->column.text).name);
        names.push_back(signal.name.text);
      }
    }
  }
  return names;
}

void requireTrainedExcitation(const ExperimentSpec& experiment, const Table& table, double start) {
  for (const SignalSpec& signal : experiment.model.excitation) {
    for (const TableSpec& trained : signal.tables) {
      if (trained.measured && trained.findDelay() == nullptr) {
        compare(experiment, signal, trained, table, start);
      }
    }
  }
}

}  // namespace twinmap
