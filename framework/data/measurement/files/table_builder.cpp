#include "framework/data/measurement/files/table_builder.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"

namespace twinmap {

TableBuilder::TableBuilder(const std::string& source, const std::vector<std::string>& wanted,
                           MissingCells missing)
    : table_{source, {}, {}}, wanted_(wanted), missing_(missing) {}

bool TableBuilder::isWanted(const std::string& name) const {
  return std::find(wanted_.begin(), wanted_.end(), name) != wanted_.end();
}

bool TableBuilder::wantsAnyOf(const std::string& prefix) const {
  return wantsAll() || std::any_of(wanted_.begin(), wanted_.end(),
                                   [&](const std::string& name) { return name.rfind(prefix, 0) == 0; });
}

bool TableBuilder::takes(const std::string& name) {
  const bool taken = wantsAll() || isWanted(name);
  if (!taken) {
    table_.skipped.push_back({name, ""});
  }
  return taken;
}

void TableBuilder::reserve(std::size_t count) {
  numbers_ += count;
  if (numbers_ > kMaxNumbers) {
    throw MeasurementError(table_.source + ": has more than " + std::to_string(kMaxNumbers) +
                           " numbers in the columns that are read; cut out the part that is needed");
  }
}

void TableBuilder::add(Column column) {
  const Eigen::Index bad =
      std::find_if(column.values.begin(), column.values.end(),
                   [&](double x) {
                     return !std::isfinite(x) && !(missing_ == MissingCells::kKeep && std::isnan(x));
                   }) -
      column.values.begin();
  if (column.values.size() == 0) {
    skip(column.name, "has no samples");
  } else if (bad < column.values.size()) {
    skip(column.name, "has " + toText(column.values[bad]) + " at row " + std::to_string(bad + 1) +
                          "; must be a finite number");
  } else {
    table_.columns.push_back(std::move(column));
  }
}

void TableBuilder::skip(const std::string& name, const std::string& problem, std::size_t line) {
  const std::string where = table_.source + (line == 0 ? "" : ":" + std::to_string(line));
  const std::string message = where + ": column '" + name + "' " + problem;
  if (!wanted_.empty()) {
    throw MeasurementError(message);
  }
  table_.skipped.push_back({name, message});
}

Table TableBuilder::finish() {
  if (wanted_.empty() && table_.columns.empty()) {
    throw MeasurementError(table_.skipped.empty() ? table_.source + ": has no columns"
                                                  : table_.skipped.front().reason);
  }
  return std::move(table_);
}

}  // namespace twinmap
