#include "framework/data/measurement/files/read_hdf5_table.hpp"

#include <algorithm>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/measurement/files/table_builder.hpp"

namespace twinmap {
namespace {

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

}  // namespace

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

}  // namespace twinmap
