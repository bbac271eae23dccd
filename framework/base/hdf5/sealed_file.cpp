#include "framework/base/hdf5/sealed_file.hpp"

#include <fmt/core.h>

#include <fstream>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/digest.hpp"

namespace twinmap {
namespace {

constexpr const char* kTitle = "twinmap HDF5 file; XXH3-128 of all bytes from 512 on:\n";

std::string makeSeal(const std::string& bytes) {
  std::string seal = kTitle + toHex(calcDigest(bytes.data() + kSealBytes, bytes.size() - kSealBytes)) + "\n";
  seal.resize(kSealBytes, '\0');
  return seal;
}

}  // namespace

void sealFile(const std::filesystem::path& path) {
  const std::string seal = makeSeal(readBytes(path));
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.write(seal.data(), static_cast<std::streamsize>(seal.size()));
  file.flush();
  if (!file) {
    throw std::runtime_error(path.string() + ": its checksum cannot be written; is the disk full?");
  }
}

std::string readSealedFile(const std::filesystem::path& path) {
  std::string bytes = readBytes(path);
  if (bytes.size() < kSealBytes || bytes.compare(0, std::string(kTitle).size(), kTitle) != 0) {
    throw std::runtime_error(path.string() +
                             ": does not begin with a checksum: it is not a trained estimator (maps.h5), is "
                             "damaged, or was not written by this version of twinmap");
  }
  if (bytes.compare(0, kSealBytes, makeSeal(bytes)) != 0) {
    throw std::runtime_error(fmt::format(
        "{}: is damaged: the checksum of its bytes 512 to {} is wrong; copy it again, or repeat its run",
        path.string(), bytes.size()));
  }
  return bytes;
}

}  // namespace twinmap
