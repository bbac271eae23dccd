#pragma once

#include <string>
#include <vector>

#include "framework/data/measurement/files/table.hpp"

namespace twinmap {

/// Makes a table of the columns that are wanted, for the readers of the formats.
class TableBuilder {
 public:
  TableBuilder(const std::string& source, const std::vector<std::string>& wanted,
               MissingCells missing = MissingCells::kRefuse);

  const std::string& getSource() const { return table_.source; }
  bool wantsAll() const { return wanted_.empty(); }
  /// Whether a column was asked for by its name.
  bool isWanted(const std::string& name) const;
  /// Whether any column is that begins so.
  bool wantsAnyOf(const std::string& prefix) const;

  /// Whether a column is to be read; one that is not is noted as not asked for.
  bool takes(const std::string& name);

  /// Throws MeasurementError if `count` numbers more are too many for one table.
  void reserve(std::size_t count);

  /// Adds a column, unless it is empty or has a number that is neither finite nor missing.
  void add(Column column);

  /// What is wrong with a column (in a line of a text file): thrown where the column was asked for by name,
  /// else the column is skipped for that reason.
  void skip(const std::string& name, const std::string& problem, std::size_t line = 0);

  /// Throws MeasurementError if there is no column of numbers, though all were wanted.
  Table finish();

 private:
  Table table_;
  std::vector<std::string> wanted_;
  MissingCells missing_;
  std::size_t numbers_ = 0;
};

}  // namespace twinmap
