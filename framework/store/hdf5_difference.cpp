#include "framework/store/hdf5_difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_handle.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

Hdf5Handle openFile(const fs::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
          path.string() + ": cannot be opened as an HDF5 file"};
}

herr_t keepDataset(hid_t /*root*/, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
  }
  return 0;
}

std::vector<std::string> listDatasets(const Hdf5Handle& file, const fs::path& path) {
  std::vector<std::string> names;
  requireHdf5(H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_INC, keepDataset, &names, H5O_INFO_BASIC),
              path.string() + ": its datasets cannot be listed");
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct Data {
  H5T_class_t type;
  std::vector<hsize_t> shape;
  std::size_t element_size;
  std::string bytes;
};

Data readData(const Hdf5Handle& file, const std::string& name) {
  const std::string what = name + " cannot be read";
  const Hdf5Handle data(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose, what);
  const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose, what);
  Data read{H5Tget_class(type.get()), {}, H5Tget_size(type.get()), {}};
  read.shape.resize(std::max(0, H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), read.shape.data(), nullptr);
  read.bytes.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())) * read.element_size);
  requireHdf5(H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, read.bytes.data()), what);
  return read;
}

std::string describeElement(const Data& data, std::size_t element) {
  const char* at = data.bytes.data() + element * data.element_size;
  if (data.type == H5T_FLOAT && data.element_size == sizeof(double)) {
    double value = 0.0;
    std::memcpy(&value, at, sizeof value);
    return toText(value);
  }
  if (data.type == H5T_INTEGER && data.element_size == sizeof(std::int64_t)) {
    std::int64_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return std::to_string(value);
  }
  const std::string text(at, data.element_size);
  return "'" + text.substr(0, text.find('\0')) + "'";
}

/// "[3, 0, 12]"; "" of a single number.
std::string describePlace(const std::vector<hsize_t>& shape, std::size_t element) {
  std::string place;
  for (auto extent = shape.rbegin(); extent != shape.rend(); ++extent) {
    place = std::to_string(element % *extent) + (place.empty() ? "" : ", ") + place;
    element /= *extent;
  }
  return place.empty() ? "" : "[" + place + "]";
}

std::string findDataDifference(const std::string& name, const Data& data, const Data& expected) {
  if (data.type != expected.type || data.shape != expected.shape ||
      data.element_size != expected.element_size) {
    return name + ": has another shape or type";
  }
  const auto differs = std::mismatch(data.bytes.begin(), data.bytes.end(), expected.bytes.begin());
  if (differs.first == data.bytes.end()) {
    return "";
  }
  const std::size_t element =
      static_cast<std::size_t>(differs.first - data.bytes.begin()) / data.element_size;
  return name + describePlace(data.shape, element) + ": " + describeElement(data, element) + " instead of " +
         describeElement(expected, element);
}

std::string findByteDifference(const fs::path& file, const fs::path& expected) {
  const std::string bytes = readBytes(file), expected_bytes = readBytes(expected);
  if (bytes == expected_bytes) {
    return "";
  }
  const std::size_t common = std::min(bytes.size(), expected_bytes.size());
  const auto differs = std::mismatch(bytes.begin(), bytes.begin() + common, expected_bytes.begin());
  return fmt::format("all data are equal, but byte {} differs (an attribute or the file's structure)",
                     differs.first - bytes.begin());
}

}  // namespace

std::string findHdf5Difference(const fs::path& file, const fs::path& expected) {
  const Hdf5Handle found = openFile(file), other = openFile(expected);
  const std::vector<std::string> names = listDatasets(found, file);
  const std::vector<std::string> expected_names = listDatasets(other, expected);
  for (const std::string& name : names) {
    if (!contains(expected_names, name)) {
      return name + ": should not be there";
    }
  }
  for (const std::string& name : expected_names) {
    if (!contains(names, name)) {
      return name + ": is missing";
    }
  }
  for (const std::string& name : names) {
    const std::string difference = findDataDifference(name, readData(found, name), readData(other, name));
    if (!difference.empty()) {
      return difference;
    }
  }
  return findByteDifference(file, expected);
}

}  // namespace twinmap
