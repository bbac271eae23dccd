#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/base/hdf5/hdf5_handle.hpp"
#include "framework/base/hdf5/sealed_file.hpp"

namespace twinmap {
namespace {

constexpr std::size_t kImageStep = 1 << 16;  // of memory that a growing file would take; none does

Hdf5Handle openDataset(hid_t file, const std::string& path, const std::string& dataset) {
  return {H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose, path + ": has no dataset " + dataset};
}

std::vector<std::size_t> getShape(const Hdf5Handle& data) {
  const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose, "HDF5 data space");
  std::vector<hsize_t> extents(H5Sget_simple_extent_ndims(space.get()));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

std::size_t countValues(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

herr_t addDataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  }
  return 0;
}

std::string readVariableLengthText(const Hdf5Handle& attribute, const Hdf5Handle& type,
                                   const std::string& what) {
  char* text = nullptr;
  requireHdf5(H5Aread(attribute.get(), type.get(), &text), what);
  const std::string copy = text == nullptr ? "" : text;
  H5free_memory(text);
  return copy;
}

// HDF5 would copy an image twice, a tenth of the time of an inference. Of a file that is only read it may
// have the bytes where they are, until it closes the file.

/// The images of open files, by their address. With the library locked.
std::map<const void*, std::string>& updImages() {
  static std::map<const void*, std::string> images;
  return images;
}

void* takeImage(size_t, H5FD_file_image_op_t, void* image) {
  return image;
}
void* copyImage(void* target, const void* source, size_t size, H5FD_file_image_op_t, void*) {
  return target == source ? target : std::memcpy(target, source, size);
}
void* refuseToResizeImage(void*, size_t, H5FD_file_image_op_t, void*) {
  return nullptr;
}
herr_t freeImage(void* image, H5FD_file_image_op_t operation, void*) {
  if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE) {
    updImages().erase(image);
  }
  return 0;
}
void* shareImage(void* image) {
  return image;
}
herr_t releaseImage(void*) {
  return 0;
}

/// Opens bytes of a file that has this name; below 0 where it cannot.
hid_t openImage(const std::string& name, std::string bytes) {
  void* const image = bytes.data();
  const std::size_t size = bytes.size();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "HDF5 property list");
  H5FD_file_image_callbacks_t callbacks{takeImage,    copyImage, refuseToResizeImage, freeImage, shareImage,
                                        releaseImage, image};
  updImages().emplace(image, std::move(bytes));
  const bool ready = H5Pset_fapl_core(access.get(), kImageStep, 0) >= 0 &&
                     H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0 &&
                     H5Pset_file_image(access.get(), image, size) >= 0;
  const hid_t file = ready ? H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()) : -1;
  if (file < 0) {
    updImages().erase(image);
  }
  return file;
}

std::string trimZeros(const std::string& padded) {
  return padded.substr(0, padded.find('\0'));
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path, Hdf5Seal seal) : path_(path.string()) {
  // HDF5 refuses an image under the name of a file that exists
  file_ = seal == Hdf5Seal::kDigest ? openImage(path_ + "/image", readSealedFile(path))
                                    : H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) {
    throw std::runtime_error(path_ + ": cannot be opened as an HDF5 file");
  }
}

Hdf5Reader::~Hdf5Reader() {
  H5Fclose(file_);
}

bool Hdf5Reader::contains(const std::string& dataset) const {
  return H5Lexists(file_, dataset.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Reader::listDatasets() const {
  std::vector<std::string> names;
  requireHdf5(H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, addDataset, &names, H5O_INFO_BASIC),
              path_ + ": cannot be listed");
  return names;
}

bool Hdf5Reader::isRealNumber(const std::string& dataset) const {
  const Hdf5Handle data = openDataset(file_, path_, dataset);
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose, "HDF5 type");
  const H5T_class_t kind = H5Tget_class(type.get());
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

std::vector<std::size_t> Hdf5Reader::readShape(const std::string& dataset) const {
  return getShape(openDataset(file_, path_, dataset));
}

Eigen::MatrixXd Hdf5Reader::readSamples(const std::string& dataset) const {
  const Hdf5Handle data = openDataset(file_, path_, dataset);
  const std::vector<std::size_t> shape = getShape(data);
  const bool is_table = shape.size() >= 2;
  const std::size_t columns = is_table ? shape[0] : 1;
  const std::size_t rows = countValues({shape.begin() + (is_table ? 1 : 0), shape.end()});
  Eigen::MatrixXd values(rows, columns);
  requireHdf5(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              path_ + ": " + dataset + " cannot be read");
  return values;
}

Eigen::VectorXd Hdf5Reader::readVector(const std::string& dataset) const {
  const Hdf5Handle data = openDataset(file_, path_, dataset);
  const std::vector<std::size_t> shape = getShape(data);
  if (shape.size() >= 2 && shape[0] != 1) {
    throw std::runtime_error(path_ + ": " + dataset + " is not a vector");
  }
  Eigen::VectorXd values(static_cast<Eigen::Index>(countValues(shape)));
  requireHdf5(H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              path_ + ": " + dataset + " cannot be read");
  return values;
}

double Hdf5Reader::readNumber(const std::string& dataset) const {
  const Eigen::MatrixXd values = readSamples(dataset);
  if (values.size() != 1) {
    throw std::runtime_error(path_ + ": " + dataset + " is not one number");
  }
  return values(0, 0);
}

std::int64_t Hdf5Reader::readCount(const std::string& dataset) const {
  constexpr double kMost = 1e6;
  const double number = readNumber(dataset);
  if (!(number >= 0.0 && number <= kMost && number == std::floor(number))) {
    throw std::runtime_error(path_ + ": " + dataset + " is not a count");
  }
  return static_cast<std::int64_t>(number);
}

std::vector<std::int64_t> Hdf5Reader::readIntegers(const std::string& dataset) const {
  const Hdf5Handle data = openDataset(file_, path_, dataset);
  std::vector<std::int64_t> values(countValues(getShape(data)));
  requireHdf5(H5Dread(data.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
              path_ + ": " + dataset + " cannot be read");
  return values;
}

std::vector<std::string> Hdf5Reader::readTexts(const std::string& dataset) const {
  const Hdf5Handle data = openDataset(file_, path_, dataset);
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose, "HDF5 type");
  const std::size_t length = H5Tget_size(type.get());
  const std::size_t count = countValues(getShape(data));
  std::string padded(count * length, '\0');
  requireHdf5(H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()),
              path_ + ": " + dataset + " cannot be read");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(trimZeros(padded.substr(i * length, length)));
  }
  return texts;
}

bool Hdf5Reader::hasAttribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5Reader::readAttribute(const std::string& object, const std::string& name) const {
  const std::string what = path_ + ": has no attribute " + name + " of " + object;
  const Hdf5Handle attribute(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, what);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose, what);
  if (H5Tget_class(type.get()) != H5T_STRING) {
    throw std::runtime_error(what + " that is a text");
  }
  if (H5Tis_variable_str(type.get()) > 0) {
    return readVariableLengthText(attribute, type, what);
  }
  std::string padded(H5Tget_size(type.get()), '\0');
  requireHdf5(H5Aread(attribute.get(), type.get(), padded.data()), what);
  return trimZeros(padded);
}

}  // namespace twinmap
