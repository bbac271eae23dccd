#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/text/source_location.hpp"

namespace twinmap {

/// A file of measurements that cannot be used. The message names the file, where known the line or the time,
/// the column, the value and the rule that it breaks.
class MeasurementError : public ExperimentError {
 public:
  explicit MeasurementError(const std::string& message) : ExperimentError(message) {}
};

/// Numbers under a name, as they stand in the file.
struct Column {
  std::string name;
  std::optional<std::string> unit;  ///< as the file states it
  Eigen::VectorXd values;
};

/// A column of the file that was not read.
struct SkippedColumn {
  std::string name;
  std::string reason;  ///< "" if it was not asked for; else the whole message
};

/// Columns of a file of measurements. All numbers are finite, or NaN where cells may be missing
/// (MissingCells); no column is empty. Those of a text file have the same length.
struct Table {
  std::string source;  ///< names the file in errors
  std::vector<Column> columns;
  std::vector<SkippedColumn> skipped;
};

/// What becomes of a cell without a number: empty, nan, NA, N/A, null, none, - or ?, and NaN in a binary
/// file.
enum class MissingCells {
  kRefuse,  ///< MeasurementError
  kKeep,    ///< NaN
};

/// The most numbers that are kept of one file (0.8 GB).
constexpr std::size_t kMaxNumbers = 100'000'000;

/// Reads a text table in one pass, memory for the wanted columns only. Lines that are empty or comments (#)
/// are left out. The first line names the columns, "enc1" or "enc1 [mm]", perhaps in quotes, or one below a
/// block of remarks; a line of units may follow (findCsvLayout, which also finds what separates cells).
/// Columns without a name are ignored. Numbers have a decimal point, or all a decimal comma where cells are
/// not separated by commas; a date and time is the seconds since 1970 (parseTimeStamp). UTF-8, with or
/// without byte-order mark.
Table readCsv(std::istream& stream, const std::string& source, const std::vector<std::string>& wanted = {},
              MissingCells missing = MissingCells::kRefuse);

/// The column of that name, or nullptr. Throws MeasurementError where it was skipped for a reason.
const Column* findColumn(const Table& table, const std::string& name);

/// The same; throws MeasurementError where there is none, with the nearest name and a list of all.
const Column& getColumn(const Table& table, const std::string& name);

/// Writes columns of equal length as CSV: names with units, numbers that read back as the same bits.
void writeTable(std::ostream& stream, const std::vector<Column>& columns);
void writeTable(const std::filesystem::path& path, const std::vector<Column>& columns);

}  // namespace twinmap
