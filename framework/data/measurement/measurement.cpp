#include "framework/data/measurement/measurement.hpp"

#include <algorithm>

#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

TimeBase makeTimeBase(const MeasurementSpec& spec) {
  return {spec.time, spec.sample_rate, spec.start};
}

}  // namespace

ColumnSpec findColumnSpec(const MeasurementSpec& spec, const std::string& output) {
  for (const MeasuredColumnSpec& measured : spec.columns) {
    if (measured.name.text == output) {
      return measured.column;
    }
  }
  return {output, {}, {}};
}

std::vector<std::string> listColumns(const MeasurementSpec& spec, const std::vector<std::string>& outputs) {
  std::vector<std::string> names = listTimeColumns(makeTimeBase(spec));
  for (const std::string& output : outputs) {
    names.push_back(findColumnSpec(spec, output).name);
  }
  return names;
}

Measurement readMeasurement(const Table& table, const MeasurementSpec& spec, const ResponseLayout& layout) {
  constexpr Index kMargin = 3;  // samples for the cubic beside the first and the last needed time
  std::vector<ColumnSpec> columns;
  for (const std::string& output : layout.output_names) {
    columns.push_back(findColumnSpec(spec, output));
  }
  const Index rows = columns.empty() ? 0 : getColumn(table, columns.front().name).values.size();
  const Eigen::VectorXd times = readTimes(table, makeTimeBase(spec), rows);
  const bool any = layout.times.size() > 0;
  const RowRange range =
      any ? findRows(times, layout.times[0], layout.times[layout.times.size() - 1], kMargin)
          : RowRange{0, times.size()};
  Measurement measurement{table.source,
                          times.segment(range.first, range.count),
                          {},
                          Eigen::MatrixXd(range.count, layout.getOutputCount())};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    requireLength(table, getColumn(table, columns[i].name), times.size());
    measurement.column_names.push_back(columns[i].name);
    measurement.values.col(static_cast<Index>(i)) =
        readValues(table, columns[i], layout.output_units[i], range.first, range.count);
  }
  return measurement;
}

}  // namespace twinmap
