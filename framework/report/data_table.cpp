#include "framework/report/data_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

Json roundNumber(double value) {
  constexpr int kDigits = 7;
  double rounded = 0.0;
  if (!parseLiteral(toShortText(value, kDigits), rounded)) {
    return nullptr;
  }
  constexpr double kExactIntegers = 1e15;
  if (rounded == std::floor(rounded) && std::abs(rounded) < kExactIntegers) {
    return static_cast<std::int64_t>(rounded);  // "3" rather than "3.0"
  }
  return rounded;
}

Json toJsonArray(const DataTable::Column& column) {
  auto array = Json::array();
  if (const auto* numbers = std::get_if<std::vector<double>>(&column)) {
    for (const double value : *numbers) {
      array.push_back(roundNumber(value));
    }
  } else {
    array = std::get<std::vector<std::string>>(column);
  }
  return array;
}

std::string getCell(const DataTable::Column& column, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&column)) {
    return std::isfinite((*numbers)[row]) ? toText((*numbers)[row]) : "";
  }
  return escapeCsv(std::get<std::vector<std::string>>(column)[row]);
}

}  // namespace

void DataTable::add(const std::string& name, std::vector<double> numbers) {
  const std::size_t rows = numbers.size();
  insert(name, std::move(numbers), rows);
}

void DataTable::add(const std::string& name, std::vector<std::string> texts) {
  const std::size_t rows = texts.size();
  insert(name, std::move(texts), rows);
}

void DataTable::insert(const std::string& name, Column column, std::size_t rows) {
  assert(columns_.empty() || rows == row_count_);
  row_count_ = rows;
  columns_.emplace_back(name, std::move(column));
}

bool DataTable::hasColumn(const std::string& name) const {
  return std::any_of(columns_.begin(), columns_.end(),
                     [&](const auto& column) { return column.first == name; });
}

Json DataTable::toJson() const {
  Json json = Json::object();
  for (const auto& [name, column] : columns_) {
    json[name] = toJsonArray(column);
  }
  return json;
}

std::string DataTable::toCsv() const {
  std::string csv;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    csv += (i == 0 ? "" : ",") + escapeCsv(columns_[i].first);
  }
  csv += "\n";
  for (std::size_t row = 0; row < row_count_; ++row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      csv += (i == 0 ? "" : ",") + getCell(columns_[i].second, row);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace twinmap
