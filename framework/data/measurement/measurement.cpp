#include "framework/data/measurement/measurement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/trigger.hpp"
#include "framework/experiment/expression/units.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const MeasuredColumnSpec* findListed(const MeasurementSpec& spec, const std::string& output) {
  const auto found =
      std::find_if(spec.columns.begin(), spec.columns.end(),
                   [&](const MeasuredColumnSpec& measured) { return measured.name.text == output; });
  return found == spec.columns.end() ? nullptr : &*found;
}

double getDelay(const MeasuredColumnSpec& measured) {
  double delay = 0.0;
  parseLiteral(measured.delay.text, delay);
  return delay;
}

}  // namespace

ColumnSpec findColumnSpec(const MeasurementSpec& spec, const std::string& output) {
  const MeasuredColumnSpec* listed = findListed(spec, output);
  return listed != nullptr && listed->column ? *listed->column : ColumnSpec{output, {}, {}};
}

TimeBase makeTimeBase(const MeasurementSpec& spec, double start) {
  return {spec.time, spec.sample_rate, start};
}

TimeBase makeTimeBase(const MeasurementSpec& spec, const std::string& output, double start) {
  const MeasuredColumnSpec* listed = findListed(spec, output);
  if (listed == nullptr) {
    return makeTimeBase(spec, start);
  }
  const double zero = start + getDelay(*listed);
  return listed->time || listed->sample_rate ? TimeBase{listed->time, listed->sample_rate, zero}
                                             : makeTimeBase(spec, zero);
}

std::optional<std::filesystem::path> findOwnFile(const MeasurementSpec& spec, const std::string& output,
                                                 const std::string& source) {
  const MeasuredColumnSpec* listed = findListed(spec, output);
  if (listed == nullptr || !listed->file) {
    return std::nullopt;
  }
  return std::filesystem::path(source).parent_path() / listed->file->text;
}

bool hasOwnClocks(const MeasurementSpec& spec) {
  return std::any_of(spec.columns.begin(), spec.columns.end(), [](const MeasuredColumnSpec& measured) {
    return measured.file || measured.time || measured.sample_rate || getDelay(measured) != 0.0;
  });
}

bool isUnwrapped(const MeasurementSpec& spec, const std::string& output) {
  return std::any_of(spec.unwrap.begin(), spec.unwrap.end(),
                     [&](const Name& name) { return name.text == output; });
}

std::optional<double> findTurn(const MeasurementSpec& spec, const std::string& output,
                               const std::string& unit) {
  for (const MeasuredRangeSpec& range : spec.ranges) {
    if (range.name.text == output && isUnwrapped(spec, output)) {
      return range.range.upper - range.range.lower;
    }
  }
  return findWholeTurn(unit);
}

std::vector<std::string> describeJumps(const Table& table, const MeasurementSpec& spec,
                                       const ResponseLayout& layout) {
  std::vector<std::string> described;
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const std::string &output = layout.output_names[o], &unit = layout.output_units[o];
    const ColumnSpec column = findColumnSpec(spec, output);
    const std::optional<double> turn = findTurn(spec, output, unit);
    if (!turn || isUnwrapped(spec, output) || findColumn(table, column.name) == nullptr) {
      continue;
    }
    const Index rows = getColumn(table, column.name).values.size();
    const std::vector<Index> jumps = findTurnJumps(readValues(table, column, unit, 0, rows), *turn);
    if (!jumps.empty()) {
      described.push_back(fmt::format(
          "{}: column '{}' jumps by a whole turn ({} {}) before row {}, {} times in all; if it is an angle "
          "that wraps, give measurement.unwrap: [{}]",
          table.source, column.name, toShortText(*turn, 4), unit, jumps.front() + 1, jumps.size(), output));
    }
  }
  return described;
}

std::vector<std::string> describeUnreadUnits(const Table& table, const MeasurementSpec& spec,
                                             const ResponseLayout& layout) {
  std::vector<std::string> described;
  const auto add = [&](const ColumnSpec& column, const std::string& unit) {
    const std::string said = describeUnreadUnit(table, column, unit);
    if (!said.empty() && std::find(described.begin(), described.end(), said) == described.end()) {
      described.push_back(said);
    }
  };
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const TimeBase base = makeTimeBase(spec, layout.output_names[o], 0.0);
    if (base.time && !base.sample_rate) {
      add(*base.time, "s");
    }
    add(findColumnSpec(spec, layout.output_names[o]), layout.output_units[o]);
  }
  return described;
}

std::vector<std::string> listColumns(const MeasurementSpec& spec, const std::vector<std::string>& outputs) {
  std::vector<std::string> names = listTimeColumns(makeTimeBase(spec, 0.0));
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  };
  for (const std::string& output : outputs) {
    add(findColumnSpec(spec, output).name);
    for (const std::string& time : listTimeColumns(makeTimeBase(spec, output, 0.0))) {
      add(time);
    }
  }
  if (const std::optional<Trigger> trigger = findTrigger(spec.start)) {
    add(trigger->column);
  }
  return names;
}

VectorXd readOutput(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                    std::size_t output, const VectorXd& times, Index first) {
  const std::string& name = layout.output_names[output];
  const VectorXd values =
      readValues(table, findColumnSpec(spec, name), layout.output_units[output], first, times.size());
  return isUnwrapped(spec, name) ? unwrap(times, values, *findTurn(spec, name, layout.output_units[output]))
                                 : values;
}

bool usesOutput(const std::vector<FeatureSpec>& features, const std::string& output) {
  const std::vector<Name> all = collectOutputs(features);
  return std::any_of(all.begin(), all.end(), [&](const Name& name) { return name.text == output; });
}

Measurement readMeasurement(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout,
                            double start, const std::vector<FeatureSpec>& features) {
  constexpr Index kMargin = 3;  // samples for the cubic beside the first and the last needed time
  std::vector<ColumnSpec> columns;
  std::vector<bool> needed;
  Index rows = 0;
  for (const std::string& output : layout.output_names) {
    columns.push_back(findColumnSpec(spec, output));
    needed.push_back(features.empty() || usesOutput(features, output));
    rows = needed.back() && rows == 0 ? getColumn(table, columns.back().name).values.size() : rows;
  }
  const Eigen::VectorXd times = readTimes(table, makeTimeBase(spec, start), rows);
  const bool any = layout.times.size() > 0;
  const RowRange range =
      any ? findRows(times, layout.times[0], layout.times[layout.times.size() - 1], kMargin)
          : RowRange{0, times.size()};
  Measurement measurement{table.source,
                          times.segment(range.first, range.count),
                          {},
                          Eigen::MatrixXd(range.count, layout.getOutputCount())};
  measurement.values.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    measurement.column_names.push_back(columns[i].name);
    if (!needed[i]) {
      continue;
    }
    requireLength(table, getColumn(table, columns[i].name), times.size());
    measurement.values.col(static_cast<Index>(i)) =
        readOutput(table, spec, layout, i, measurement.times, range.first);
  }
  return measurement;
}

double findSide(const std::optional<Bounds>& range, double value) {
  constexpr double kSame = 1e-6;
  if (!range) {
    return 0.0;
  }
  const double slack = kSame * (range->upper - range->lower);
  return value >= range->upper - slack ? 1.0 : value <= range->lower + slack ? -1.0 : 0.0;
}

std::optional<Bounds> findRange(const MeasurementSpec& spec, const std::string& output) {
  for (const MeasuredRangeSpec& range : spec.ranges) {
    if (range.name.text == output && !isUnwrapped(spec, output)) {
      return range.range;
    }
  }
  return std::nullopt;
}

void requireUnclipped(const Measurement& measurement, const MeasurementSpec& spec,
                      const ResponseLayout& layout) {
  if (layout.times.size() == 0) {
    return;
  }
  const RowRange needed =
      findRows(measurement.times, layout.times[0], layout.times[layout.times.size() - 1], 0);
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const std::optional<Bounds> range = findRange(spec, layout.output_names[o]);
    for (Index i = needed.first; i < needed.first + needed.count; ++i) {
      const double value = measurement.values(i, static_cast<Index>(o));
      if (findSide(range, value) != 0.0) {
        throw MeasurementError(fmt::format(
            "{}: column '{}' is {} at {} s, a limit of measurement.range.{}; a trained map cannot use "
            "clipped samples, inference from the experiment file can (twinmap infer FILE.yaml MEASUREMENT)",
            measurement.source, measurement.column_names[o], toText(value),
            toShortText(measurement.times[i], 6), layout.output_names[o]));
      }
    }
  }
}

}  // namespace twinmap
