#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace twinmap {

/// The library's only user, as long as it is held. HDF5 then prints no errors of its own.
std::unique_lock<std::recursive_mutex> lockHdf5();

/// Whether a file begins with a digest of all that follows (sealed_file.hpp). A sealed file is read into
/// memory and compared with its digest before HDF5 sees it, which may crash on a damaged one.
enum class Hdf5Seal { kNone, kDigest };

/// A small face on HDF5: datasets of numbers and texts by path ("/train/parameters"), groups made on the way,
/// no time stamps, so that equal content gives equal bytes. Throws std::runtime_error naming file and
/// dataset. HDF5 is not thread safe: while a thread has a file open, others wait for it.
///
/// Arrays are in C order. An Eigen matrix with one column per sample (d x n) is the C-order array (n, d),
/// written without a copy.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path, Hdf5Seal seal = Hdf5Seal::kNone);
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;
  ~Hdf5Writer();

  /// `values` holds the product of `shape` numbers in C order.
  void write(const std::string& dataset, const double* values, const std::vector<std::size_t>& shape);
  /// d x n -> (n, d).
  void writeSamples(const std::string& dataset, const Eigen::MatrixXd& columns);
  /// The same of single precision.
  void writeSingle(const std::string& dataset, const Eigen::MatrixXf& columns);
  /// A dataset (n, d) that is filled part by part; what is not written is 0.
  void createSamples(const std::string& dataset, Eigen::Index samples, Eigen::Index numbers);
  /// Columns (d x k) of it, from sample `first` on.
  void writeSamples(const std::string& dataset, Eigen::Index first, const Eigen::MatrixXd& columns);
  void write(const std::string& dataset, const Eigen::VectorXd& values);
  void write(const std::string& dataset, double value);
  void write(const std::string& dataset, const std::vector<std::int64_t>& values);
  void write(const std::string& dataset, const std::vector<std::string>& texts);
  /// A text attached to a dataset or group (also "/").
  void writeAttribute(const std::string& object, const std::string& name, const std::string& text);

  /// Flushes, closes and seals; throws if that fails. The destructor closes without a word.
  void close();

 private:
  std::int64_t createDataset(const std::string& dataset, std::int64_t type, std::int64_t space);

  std::unique_lock<std::recursive_mutex> library_ = lockHdf5();
  std::string path_;
  Hdf5Seal seal_;
  std::int64_t file_ = -1;
};

/// Reads what Hdf5Writer writes.
class Hdf5Reader {
 public:
  /// With a seal each byte is as it was written, or this throws (readSealedFile); without, one is not looked
  /// at.
  explicit Hdf5Reader(const std::filesystem::path& path, Hdf5Seal seal = Hdf5Seal::kNone);
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;
  ~Hdf5Reader();

  bool contains(const std::string& dataset) const;
  /// The paths of all datasets, without the leading '/', in the order of names.
  std::vector<std::string> listDatasets() const;
  /// Whether a dataset is of integers or floating-point numbers.
  bool isRealNumber(const std::string& dataset) const;
  std::vector<std::size_t> readShape(const std::string& dataset) const;
  const std::string& getPath() const { return path_; }
  /// (n, d) -> d x n; a vector (n) -> n x 1; a number -> 1 x 1.
  Eigen::MatrixXd readSamples(const std::string& dataset) const;
  Eigen::VectorXd readVector(const std::string& dataset) const;
  double readNumber(const std::string& dataset) const;
  /// A whole number from 0 to a million.
  std::int64_t readCount(const std::string& dataset) const;
  std::vector<std::int64_t> readIntegers(const std::string& dataset) const;
  std::vector<std::string> readTexts(const std::string& dataset) const;
  bool hasAttribute(const std::string& object, const std::string& name) const;
  /// A text of fixed or variable length.
  std::string readAttribute(const std::string& object, const std::string& name) const;

 private:
  std::unique_lock<std::recursive_mutex> library_ = lockHdf5();
  std::string path_;
  std::int64_t file_ = -1;
};

}  // namespace twinmap
