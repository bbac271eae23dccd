#include "framework/data/measurement/files/table.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> listNames(const Table& table) {
  std::vector<std::string> names;
  for (const Column& column : table.columns) {
    names.push_back(column.name);
  }
  for (const SkippedColumn& column : table.skipped) {
    names.push_back(column.name);
  }
  return names;
}

std::string joinNames(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMax); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text + (names.size() > kMax ? ", ..." : "");
}

std::string escapeCell(const std::string& text) {
  if (text.find_first_of(",;\t\"#") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + "\"";
}

}  // namespace

const Column* findColumn(const Table& table, const std::string& name) {
  for (const Column& column : table.columns) {
    if (column.name == name) {
      return &column;
    }
  }
  for (const SkippedColumn& column : table.skipped) {
    if (column.name == name && !column.reason.empty()) {
      throw MeasurementError(column.reason);
    }
  }
  return nullptr;
}

const Column& getColumn(const Table& table, const std::string& name) {
  const Column* column = findColumn(table, name);
  if (column == nullptr) {
    const std::vector<std::string> names = listNames(table);
    throw MeasurementError(table.source + ": has no column '" + name + "'" + suggestName(name, names) +
                           " (it has: " + joinNames(names) + ")");
  }
  return *column;
}

void writeTable(std::ostream& stream, const std::vector<Column>& columns) {
  std::string text;
  for (const Column& column : columns) {
    text += (text.empty() ? "" : ",") + escapeCell(toText(ColumnSpec{column.name, column.unit, {}}));
  }
  stream << text << "\n";
  const Eigen::Index rows = columns.empty() ? 0 : columns.front().values.size();
  for (Eigen::Index row = 0; row < rows; ++row) {
    text.clear();
    for (const Column& column : columns) {
      text += (text.empty() ? "" : ",") + toText(column.values[row]);
    }
    stream << text << "\n";
  }
}

void writeTable(const fs::path& path, const std::vector<Column>& columns) {
  std::ofstream file(path, std::ios::binary);
  writeTable(file, columns);
  file.close();
  if (!file) {
    throw MeasurementError(path.string() + ": cannot be written");
  }
}

}  // namespace twinmap
