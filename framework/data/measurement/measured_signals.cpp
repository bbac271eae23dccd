#include "framework/data/measurement/measured_signals.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "framework/data/measurement/bridged_gaps.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measurement_start.hpp"
#include "framework/data/measurement/recording.hpp"
#include "framework/data/measurement/row_order.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

TimeBase makeTimeBase(const MeasuredSignalSpec& spec, double start) {
  return {spec.time ? std::make_optional(parseColumn(spec.time->text, spec.time->where)) : std::nullopt,
          spec.sample_rate, start};
}

std::vector<std::string> listColumns(const MeasuredSignalSpec& spec) {
  std::vector<std::string> names = listTimeColumns(makeTimeBase(spec, 0.0));
  names.push_back(parseColumn(spec.column.text).name);
  return names;
}

/// The delays of a table within the bounds of the parameters: by changing one of them after the other, which
/// is exact for sums of parameters.
Bounds calcDelays(const ModelSpec& model, const TableSpec& table) {
  const Expression* delay = table.findDelay();
  if (delay == nullptr) {
    return {0.0, 0.0, {}};
  }
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  ModelNumbers numbers(model);
  const auto calc = [&](const VectorXd& point) {
    numbers.update(point);
    return numbers.calc(*delay, {"measured", "delay", "s"});
  };
  const VectorXd center = calcBoxCenter(sampled);
  const double middle = calc(center);
  Bounds delays{middle, middle, {}};
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    VectorXd below = center, above = center;
    below[static_cast<Index>(i)] = sampled[i].bounds.lower;
    above[static_cast<Index>(i)] = sampled[i].bounds.upper;
    const double first = calc(below) - middle, last = calc(above) - middle;
    delays.lower += std::min({0.0, first, last});
    delays.upper += std::max({0.0, first, last});
  }
  return delays;
}

/// That the times cover the excerpt, from `begin` to `end`.
void requireExcerpt(const std::string& source, const VectorXd& times, double start, double begin,
                    double end) {
  if (times.size() < 2) {
    throw MeasurementError(source + ": has " + std::to_string(times.size()) +
                           " samples; must have at least 2");
  }
  const double step = calcMedianStep(times);
  if (times[0] > begin + kSameTime * step || times[times.size() - 1] < end - kSameTime * step) {
    const double last = times[times.size() - 1];
    const bool elsewhere = times[0] > end || last < begin;
    throw MeasurementError(source + ": covers " + describeTime(start + times[0]) + " to " +
                           describeTime(start + last) + ", but " + describeTime(start + begin) + " to " +
                           describeTime(start + end) + " is needed" +
                           (elsewhere ? "; give the time in the file that is the model's 0 (start)" : ""));
  }
}

/// Repeats the first and the last value, so that the table goes from `begin` to `end` at least.
void holdEnds(TableSpec& table, double begin, double end) {
  const double step =
      (table.times.back() - table.times.front()) / static_cast<double>(table.times.size() - 1);
  const auto count = [&](double missing) {
    return missing > kSameTime * step ? static_cast<std::size_t>(std::ceil(missing / step)) : 0;
  };
  const std::size_t before = count(table.times.front() - begin), behind = count(end - table.times.back());
  std::vector<double> times;
  for (std::size_t i = before; i > 0; --i) {
    times.push_back(table.times.front() - static_cast<double>(i) * step);
  }
  table.times.insert(table.times.begin(), times.begin(), times.end());
  table.values.insert(table.values.begin(), before, table.values.front());
  for (TableUnknown& unknown : table.unknown) {
    unknown.first += before;
  }
  for (std::size_t i = 0; i < behind; ++i) {
    table.times.push_back(table.times.back() + step);
    table.values.push_back(table.values.back());
  }
}

constexpr Index kMaxSamples = 400'000;  // resolved experiments hold them, and at most a million values
constexpr Index kMargin = 4;            // samples beside, for interpolation that looks at neighbours

/// A measured column, in the signal's unit, at the rows that have a time and a value.
Samples readColumn(const Table& table, const MeasuredSignalSpec& spec, const std::string& unit,
                   double start) {
  const ColumnSpec column = parseColumn(spec.column.text, spec.column.where);
  const Column& found = getColumn(table, column.name);
  const TimeBase base = makeTimeBase(spec, start);
  const VectorXd times = readUnorderedTimes(table, base, found.values.size());
  requireClock(table, base, times);
  requireLength(table, found, times.size());
  const std::vector<Index> rows = sortRows(times).rows;
  const VectorXd values = readValues(table, column, unit, 0, times.size());
  return takeSamples(times(rows), values(rows));
}

void assign(TableSpec& target, const Samples& samples, const RowRange& range) {
  const double* times = samples.times.data() + range.first;
  const double* values = samples.values.data() + range.first;
  target.times.assign(times, times + range.count);
  target.values.assign(values, values + range.count);
}

/// delays: of the table's clock, so that it is needed from the earliest time to the latest.
void fill(TableSpec& target, const Table& table, const std::string& unit, double start, double duration,
          const Bounds& delays) {
  const Samples samples = readColumn(table, *target.measured, unit, start);
  const bool excerpt = target.measured->duration && *target.measured->duration < duration;
  const double begin = excerpt ? 0.0 : delays.lower;
  const double end = excerpt ? *target.measured->duration : duration + delays.upper;
  const RowRange range = findRows(samples.times, begin, end, kMargin);
  requireExcerpt(table.source, samples.times.segment(range.first, range.count), start, begin, end);
  if (range.count > kMaxSamples) {
    throw MeasurementError(table.source + ": has more than 400000 samples in the time that is simulated; " +
                           "resample the signal");
  }
  assign(target, samples, excerpt ? findRows(samples.times, 0.0, end, 0) : range);
  bridgeGaps(target, table.source, start, begin, end);
}

/// Of another recording, whose time `start` is t = 0. It is needed over the simulation alone; where it ends
/// within `reach`, its ends are held.
void fillRecorded(TableSpec& target, const Table& table, const std::string& unit, double start,
                  double duration, const Bounds& reach) {
  if (target.measured->duration && *target.measured->duration < duration) {
    fill(target, table, unit, start, duration, reach);
    return;
  }
  const Samples samples = readColumn(table, *target.measured, unit, start);
  const double begin = std::min(0.0, reach.lower), end = duration + std::max(0.0, reach.upper);
  const RowRange range = findRows(samples.times, begin, end, kMargin);
  requireExcerpt(table.source, samples.times.segment(range.first, range.count), start, 0.0, duration);
  assign(target, samples, range);
  bridgeGaps(target, table.source, start, begin, end);
  holdEnds(target, begin, end);
}

bool hasColumns(const Table& table, const MeasuredSignalSpec& spec) {
  const std::vector<std::string> names = listColumns(spec);
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return findColumn(table, name) != nullptr; });
}

/// The trigger from which the start of a signal in a file of its own is counted.
double findTriggerBeside(const MeasuredSignalSpec& signal, const MeasurementSpec& measurement,
                         const Table& recording) {
  try {
    return findStart(recording, measurement);
  } catch (const MeasurementError& error) {
    throw MeasurementError(signal.file.text + ": the excitation in it cannot follow the start of " +
                           recording.source + ", as its own is counted from a trigger (" + error.what() +
                           "); write the column into the recording, or measurement.start as a number");
  }
}

/// Whether the table was read from the file that the signal names.
bool isOwnFile(const Table& table, const MeasuredSignalSpec& signal) {
  std::error_code unknown;  // a table need not be of a file
  return std::filesystem::equivalent(table.source, signal.file.text, unknown);
}

/// The time of a signal that is t = 0 where that of the recording is `start`. Columns of one recording share
/// its time; the signal's own file does as well, but for what the stated starts differ by. A trigger is the
/// start of the recording, and of another file what that states.
double calcSignalStart(const MeasuredSignalSpec& signal, const MeasurementSpec& measurement,
                       const Table& recording, double start) {
  const bool is_recorded = hasColumns(recording, signal);
  if (is_recorded && (measurement.start.when || !isOwnFile(recording, signal))) {
    return start;
  }
  const double stated =
      measurement.start.when ? findTriggerBeside(signal, measurement, recording) : measurement.start.time;
  return signal.start == stated ? start : signal.start + (start - stated);
}

/// The recording where it has the columns, else the signal's own file.
Table readSignal(const Table& recording, const MeasuredSignalSpec& spec) {
  return hasColumns(recording, spec) ? recording
                                     : readTable(spec.file.text, listColumns(spec), MissingCells::kKeep);
}

template <class Action>
void visitMeasured(ExperimentSpec& experiment, const Action& action) {
  for (SignalSpec& signal : experiment.model.excitation) {
    for (TableSpec& table : signal.tables) {
      if (table.measured) {
        action(signal, table);
      }
    }
  }
}

}  // namespace

void loadMeasuredSignals(ExperimentSpec& experiment) {
  visitMeasured(experiment, [&](const SignalSpec& signal, TableSpec& target) {
    if (!target.times.empty()) {
      return;
    }
    const MeasuredSignalSpec& spec = *target.measured;
    try {
      fill(target, readTable(spec.file.text, listColumns(spec), MissingCells::kKeep), signal.unit, spec.start,
           experiment.model.simulation.duration, calcDelays(experiment.model, target));
    } catch (const MeasurementError& error) {
      throw MeasurementError(toString(spec.file.where) + ": " + error.what());
    }
  });
}

void replaceMeasuredSignals(ExperimentSpec& experiment, const Table& recording, double start) {
  visitMeasured(experiment, [&](const SignalSpec& signal, TableSpec& target) {
    const MeasuredSignalSpec& spec = *target.measured;
    fill(target, readSignal(recording, spec), signal.unit,
         calcSignalStart(spec, experiment.measurement, recording, start),
         experiment.model.simulation.duration, calcDelays(experiment.model, target));
  });
}

bool isFollowed(const SignalSpec& signal, const ModelSpec& model) {
  const std::vector<MotionSpec>& motions = model.system.motions;
  return std::any_of(motions.begin(), motions.end(),
                     [&](const MotionSpec& motion) { return motion.follows.text == signal.name.text; });
}

bool followMeasuredSignals(ExperimentSpec& experiment, const Table& recording, double start, double beside) {
  bool changed = false;
  visitMeasured(experiment, [&](const SignalSpec& signal, TableSpec& target) {
    const MeasuredSignalSpec& spec = *target.measured;
    const double zero = calcSignalStart(spec, experiment.measurement, recording, start);
    if (zero == spec.start && !hasColumns(recording, spec)) {
      return;
    }
    TableSpec own = target;
    const Bounds delays = calcDelays(experiment.model, target);
    const double margin = isFollowed(signal, experiment.model) ? 0.0 : beside;
    fillRecorded(own, readSignal(recording, spec), signal.unit, zero, experiment.model.simulation.duration,
                 {delays.lower - margin, delays.upper + margin, {}});
    changed = changed || own.times != target.times || own.values != target.values;
    target = std::move(own);
  });
  return changed;
}

void holdMeasuredEnds(SignalSpec& signal, double duration, double beside) {
  for (TableSpec& table : signal.tables) {
    if (table.measured && !table.measured->duration && table.times.size() > 1) {
      holdEnds(table, -beside, duration + beside);
    }
  }
}

void copyMeasuredSignals(const std::vector<SignalSpec>& from, ModelSpec& model) {
  for (const SignalSpec& signal : from) {
    for (SignalSpec& own : model.excitation) {
      for (std::size_t i = 0; own.name.text == signal.name.text && i < signal.tables.size(); ++i) {
        if (signal.tables[i].measured) {
          own.tables[i].times = signal.tables[i].times;
          own.tables[i].values = signal.tables[i].values;
          own.tables[i].unknown = signal.tables[i].unknown;
          own.tables[i].bridged = signal.tables[i].bridged;
        }
      }
    }
  }
}

void dropMeasuredSignals(ExperimentSpec& experiment) {
  for (SignalSpec& signal : experiment.model.excitation) {
    for (TableSpec& table : signal.tables) {
      if (table.measured && std::filesystem::exists(table.measured->file.text)) {
        table.times.clear();
        table.values.clear();
      }
    }
  }
}

std::vector<std::string> listSignalColumns(const ExperimentSpec& experiment) {
  std::vector<std::string> names;
  for (const SignalSpec& signal : experiment.model.excitation) {
    for (const TableSpec& table : signal.tables) {
      if (table.measured) {
        const std::vector<std::string> needed = listColumns(*table.measured);
        names.insert(names.end(), needed.begin(), needed.end());
      }
    }
  }
  return names;
}

}  // namespace twinmap
