#include "framework/data/measurement/table.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/files/read_hdf5_table.hpp"
#include "framework/data/measurement/files/read_mat_table.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

Table readCsvFile(const fs::path& path, const std::vector<std::string>& wanted, MissingCells missing) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw MeasurementError(path.string() + ": cannot be opened");
  }
  return readCsv(file, path.string(), wanted, missing);
}

std::string getExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

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

std::string explainNoFile(const fs::path& path) {
  if (fs::exists(path)) {
    return ": is not a file";
  }
  const std::string text = path.string();
  if (text.find_first_not_of("0123456789") == std::string::npos) {
    return ": does not exist; a number for an option that can go without one is joined to it, as in "
           "--posterior=" +
           text;
  }
  return text.find('=') == std::string::npos
             ? ": does not exist"
             : ": does not exist; values of the experiment cannot be given here: write them into its file";
}

}  // namespace

void refuseRecording(const fs::path& run) {
  constexpr const char* kExtensions[] = {".csv", ".txt", ".tsv", ".dat", ".mat"};
  const std::string extension = getExtension(run);
  if (fs::is_regular_file(run) &&
      std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions)) {
    throw MeasurementError(
        run.string() +
        ": is a recording; first give the folder of a finished run, its maps.h5, or an experiment "
        "file (YAML), then recordings");
  }
}

Table readTable(const fs::path& path, const std::vector<std::string>& wanted, MissingCells missing) {
  if (!fs::is_regular_file(path) && !fs::is_fifo(path) && !fs::is_character_file(path)) {
    throw MeasurementError(path.string() + explainNoFile(path));
  }
  const std::string extension = getExtension(path);
  if (extension == ".mat") {
    return readMatTable(path, wanted, missing);
  }
  if (extension == ".h5" || extension == ".hdf5") {
    return readHdf5Table(path, wanted, missing);
  }
  for (const char* text : {".csv", ".txt", ".tsv", ".dat"}) {
    if (extension == text) {
      return readCsvFile(path, wanted, missing);
    }
  }
  throw MeasurementError(path.string() +
                         ": must be a .csv, .txt, .tsv, .dat, .mat, .h5 or .hdf5 file, by its name");
}

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
