#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace twinmap {

/// Bytes before an HDF5 file that HDF5 leaves to its user: those of a sealed file hold a text with the digest
/// (XXH3-128) of all bytes behind them, filled up with zeros.
constexpr std::size_t kSealBytes = 512;

/// Writes the seal of a closed file that was made with room for it. Throws std::runtime_error if that fails.
void sealFile(const std::filesystem::path& path);

/// The bytes of a sealed file, the seal's included: each is as it was written, or this throws
/// std::runtime_error naming the file and what is wrong. Cost: that of reading the file once.
std::string readSealedFile(const std::filesystem::path& path);

}  // namespace twinmap
