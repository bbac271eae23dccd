#include "framework/data/measurement/files/read_table.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "framework/data/measurement/files/read_hdf5_table.hpp"
#include "framework/data/measurement/files/read_mat_table.hpp"

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

}  // namespace twinmap
