#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "framework/base/json/json_fwd.hpp"

namespace twinmap {

/// The data of figures: named columns of equal length, of numbers or of texts.
class DataTable {
 public:
  using Column = std::variant<std::vector<double>, std::vector<std::string>>;

  void add(const std::string& name, std::vector<double> numbers);
  void add(const std::string& name, std::vector<std::string> texts);

  bool hasColumn(const std::string& name) const;
  std::size_t countRows() const { return row_count_; }

  /// {"column": [..], ..} with numbers rounded to 7 digits, more than a figure shows; NaN as null.
  Json toJson() const;
  /// With all digits.
  std::string toCsv() const;

 private:
  void insert(const std::string& name, Column column, std::size_t rows);

  std::vector<std::pair<std::string, Column>> columns_;
  std::size_t row_count_ = 0;
};

}  // namespace twinmap
