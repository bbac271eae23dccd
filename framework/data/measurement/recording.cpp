#include "framework/data/measurement/recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/row_order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The table's rows in that order; columns of other lengths stay as they are, which is found later.
Table takeRows(const Table& table, Index count, const std::vector<Index>& rows) {
  Table taken = table;
  for (Column& column : taken.columns) {
    if (column.values.size() == count) {
      column.values = VectorXd(column.values(rows));
    }
  }
  return taken;
}

std::string describeClock(const TimeBase& base) {
  return fmt::format("{} {} {}", base.time ? toText(*base.time) : "", base.sample_rate.value_or(0.0),
                     toText(base.start));
}

std::vector<std::string> listOwnColumns(const ColumnSpec& column, const TimeBase& base) {
  std::vector<std::string> names = listTimeColumns(base);
  names.push_back(column.name);
  return names;
}

}  // namespace

const ClockedRows& RecordedColumns::getRows(const std::string& output) {
  const std::optional<std::filesystem::path> file = findOwnFile(spec_, output, table_.source);
  const TimeBase base = makeTimeBase(spec_, output, start_);
  const std::string name = file ? file->string() : "", clock = describeClock(base);
  for (const ClockedRows& known : known_) {
    if (known.file == name && known.clock == clock && hasColumn(known.rows, output)) {
      return known;
    }
  }
  const ColumnSpec column = findColumnSpec(spec_, output);
  const Table own = file ? readTable(*file, listOwnColumns(column, base), MissingCells::kKeep) : Table();
  known_.push_back(sort(file ? own : table_, base, column.name));
  known_.back().file = name;
  known_.back().clock = clock;
  return known_.back();
}

bool RecordedColumns::hasColumn(const Table& rows, const std::string& output) const {
  return findColumn(rows, findColumnSpec(spec_, output).name) != nullptr;
}

ClockedRows RecordedColumns::sort(const Table& table, const TimeBase& base, const std::string& column) {
  const Index rows = getColumn(table, column).values.size();
  const VectorXd times = readUnorderedTimes(table, base, rows);
  requireClock(table, base, times);
  RowOrder order = sortRows(times);
  for (std::string& remark : order.remarks) {
    if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) {
      remarks_.push_back(std::move(remark));
    }
  }
  ClockedRows sorted{"", "", base.start, takeRows(table, rows, order.rows), {}};
  sorted.times = readUnorderedTimes(sorted.rows, base, static_cast<Index>(order.rows.size()));
  return sorted;
}

Samples takeSamples(const VectorXd& times, const VectorXd& values) {
  std::vector<Index> there;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      there.push_back(i);
    }
  }
  return {times(there), values(there)};
}

Samples readSamples(const ClockedRows& clocked, const MeasurementSpec& spec, const ResponseLayout& layout,
                    std::size_t output) {
  requireLength(clocked.rows, getColumn(clocked.rows, findColumnSpec(spec, layout.output_names[output]).name),
                clocked.times.size());
  return takeSamples(clocked.times, readOutput(clocked.rows, spec, layout, output, clocked.times, 0));
}

}  // namespace twinmap
