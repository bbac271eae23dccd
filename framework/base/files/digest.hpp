#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

namespace twinmap {

/// A 128-bit digest of bytes: XXH3-128 (xxHash) in its canonical, big-endian form. It finds accidents, not
/// forgeries: two different texts or a damaged file share it with a probability of 2^-128.
using Digest = std::array<unsigned char, 16>;

/// About 10 GB/s.
Digest calcDigest(const void* bytes, std::size_t size);

/// Of a whole file, read in pieces. Throws std::runtime_error if it cannot be read.
Digest calcFileDigest(const std::filesystem::path& path);

/// 32 lower-case hexadecimal digits.
std::string toHex(const Digest& digest);

}  // namespace twinmap
