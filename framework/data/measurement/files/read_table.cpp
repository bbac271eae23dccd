#include "framework/data/measurement/files/read_table.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/measurement/files/read_mat_table.hpp"
#include "framework/data/measurement/files/table_builder.hpp"

namespace twinmap {

namespace {

namespace fs = std::filesystem;

/// How many numbers a vector has, also one that is written as a matrix of one row or column; none otherwise.
std::optional<std::size_t> countVectorElements(const std::vector<std::size_t>& shape) {
  const auto longer = std::count_if(shape.begin(), shape.end(), [](std::size_t n) { return n != 1; });
  if (shape.empty() || longer > 1) {
    return {};
  }
  return *std::max_element(shape.begin(), shape.end()) *
         (longer == 0 || *std::min_element(shape.begin(), shape.end()) > 0);
}

std::optional<std::string> readUnit(const Hdf5Reader& file, const std::string& dataset) {
  for (const char* name : {"unit", "units"}) {
    if (file.hasAttribute(dataset, name)) {
      return file.readAttribute(dataset, name);
    }
  }
  return {};
}

void addDataset(const Hdf5Reader& file, const std::string& name, TableBuilder& table) {
  const std::optional<std::size_t> count = countVectorElements(file.readShape(name));
  if (!file.isRealNumber(name)) {
    table.skip(name, "is not a dataset of real numbers");
  } else if (!count) {
    table.skip(name, "must have one dimension");
  } else {
    table.reserve(*count);
    const Eigen::MatrixXd values = file.readSamples(name);
    table.add({name, readUnit(file, name), values.reshaped()});
  }
}

/// See readTable().
Table readHdf5Table(const std::filesystem::path& path, const std::vector<std::string>& wanted,
                    MissingCells missing) {
  try {
    const Hdf5Reader file(path);
    TableBuilder table(path.string(), wanted, missing);
    for (const std::string& name : file.listDatasets()) {
      if (table.takes(name)) {
        addDataset(file, name, table);
      }
    }
    return table.finish();
  } catch (const MeasurementError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw MeasurementError(error.what());
  }
}

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
    throw MeasurementError(run.string() +
                           ": is a recording; first give the folder of a finished run, its maps.h5, or an "
                           "experiment file (YAML), then recordings");
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

}  // namespace twinmap
