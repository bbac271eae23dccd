#include <algorithm>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/base/hdf5/hdf5_handle.hpp"
#include "framework/base/hdf5/sealed_file.hpp"

namespace twinmap {
namespace {

/// Texts as fixed-length, zero-padded UTF-8, which h5py and MATLAB's h5read both know.
Hdf5Handle makeTextType(std::size_t length) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "HDF5 text type");
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  return type;
}

Hdf5Handle makeSpace(const std::vector<std::size_t>& shape) {
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  const hid_t space = extents.empty()
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  return {space, H5Sclose, "HDF5 data space"};
}

}  // namespace

std::unique_lock<std::recursive_mutex> lockHdf5() {
  static std::recursive_mutex mutex;
  std::unique_lock lock(mutex);
  // At exit the library would try once more to write a file for which the disk had no room, and crash.
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return lock;
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path, Hdf5Seal seal) : path_(path.string()), seal_(seal) {
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "HDF5 property list");
  if (seal == Hdf5Seal::kDigest) {
    H5Pset_userblock(creation.get(), kSealBytes);
  }
  file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT);
  if (file_ < 0) {
    throw std::runtime_error(path_ + ": cannot be created as an HDF5 file");
  }
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) {
    H5Fclose(file_);
  }
}

void Hdf5Writer::close() {
  const hid_t file = file_;
  file_ = -1;
  requireHdf5(H5Fclose(file), path_ + ": cannot be closed; is the disk full?");
  if (seal_ == Hdf5Seal::kDigest) {
    sealFile(path_);
  }
}

std::int64_t Hdf5Writer::createDataset(const std::string& dataset, std::int64_t type, std::int64_t space) {
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "HDF5 property list");
  H5Pset_create_intermediate_group(links.get(), 1);
  const Hdf5Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "HDF5 property list");
  H5Pset_obj_track_times(options.get(), false);
  return H5Dcreate2(file_, dataset.c_str(), type, space, links.get(), options.get(), H5P_DEFAULT);
}

void Hdf5Writer::write(const std::string& dataset, const double* values,
                       const std::vector<std::size_t>& shape) {
  const std::string what = path_ + ": " + dataset + " cannot be written";
  const Hdf5Handle space = makeSpace(shape);
  const Hdf5Handle data(createDataset(dataset, H5T_IEEE_F64LE, space.get()), H5Dclose, what);
  requireHdf5(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
}

void Hdf5Writer::writeSamples(const std::string& dataset, const Eigen::MatrixXd& columns) {
  write(dataset, columns.data(),
        {static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows())});
}

void Hdf5Writer::writeSingle(const std::string& dataset, const Eigen::MatrixXf& columns) {
  const std::string what = path_ + ": " + dataset + " cannot be written";
  const Hdf5Handle space =
      makeSpace({static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows())});
  const Hdf5Handle data(createDataset(dataset, H5T_IEEE_F32LE, space.get()), H5Dclose, what);
  requireHdf5(H5Dwrite(data.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, columns.data()), what);
}

void Hdf5Writer::createSamples(const std::string& dataset, Eigen::Index samples, Eigen::Index numbers) {
  const Hdf5Handle space = makeSpace({static_cast<std::size_t>(samples), static_cast<std::size_t>(numbers)});
  const Hdf5Handle data(createDataset(dataset, H5T_IEEE_F64LE, space.get()), H5Dclose,
                        path_ + ": " + dataset + " cannot be created");
}

void Hdf5Writer::writeSamples(const std::string& dataset, Eigen::Index first,
                              const Eigen::MatrixXd& columns) {
  const std::string what = path_ + ": " + dataset + " cannot be written";
  const Hdf5Handle data(H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Hdf5Handle place(H5Dget_space(data.get()), H5Sclose, what);
  const Hdf5Handle part =
      makeSpace({static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows())});
  const hsize_t offset[] = {static_cast<hsize_t>(first), 0};
  const hsize_t count[] = {static_cast<hsize_t>(columns.cols()), static_cast<hsize_t>(columns.rows())};
  requireHdf5(H5Sselect_hyperslab(place.get(), H5S_SELECT_SET, offset, nullptr, count, nullptr), what);
  requireHdf5(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, part.get(), place.get(), H5P_DEFAULT, columns.data()),
              what);
}

void Hdf5Writer::write(const std::string& dataset, const Eigen::VectorXd& values) {
  write(dataset, values.data(), {static_cast<std::size_t>(values.size())});
}

void Hdf5Writer::write(const std::string& dataset, double value) {
  write(dataset, &value, {});
}

void Hdf5Writer::write(const std::string& dataset, const std::vector<std::int64_t>& values) {
  const std::string what = path_ + ": " + dataset + " cannot be written";
  const Hdf5Handle space = makeSpace({values.size()});
  const Hdf5Handle data(createDataset(dataset, H5T_STD_I64LE, space.get()), H5Dclose, what);
  requireHdf5(H5Dwrite(data.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
}

void Hdf5Writer::write(const std::string& dataset, const std::vector<std::string>& texts) {
  const std::string what = path_ + ": " + dataset + " cannot be written";
  std::size_t length = 1;
  for (const std::string& text : texts) {
    length = std::max(length, text.size());
  }
  std::string padded;
  for (const std::string& text : texts) {
    padded += text + std::string(length - text.size(), '\0');
  }
  const Hdf5Handle type = makeTextType(length);
  const Hdf5Handle space = makeSpace({texts.size()});
  const Hdf5Handle data(createDataset(dataset, type.get(), space.get()), H5Dclose, what);
  requireHdf5(H5Dwrite(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), what);
}

void Hdf5Writer::writeAttribute(const std::string& object, const std::string& name, const std::string& text) {
  const std::string what = path_ + ": attribute " + name + " of " + object + " cannot be written";
  const Hdf5Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose, what);
  const Hdf5Handle type = makeTextType(text.size());
  const Hdf5Handle space = makeSpace({});
  const Hdf5Handle attribute(
      H5Acreate2(target.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      what);
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  requireHdf5(H5Awrite(attribute.get(), type.get(), padded.data()), what);
}

}  // namespace twinmap
