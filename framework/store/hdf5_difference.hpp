#pragma once

#include <filesystem>
#include <string>

namespace twinmap {

/// The place where an HDF5 file differs from the one that it should be equal to, bit for bit: the first
/// dataset in the order of names, its first element and both values ("/train/responses[3, 0, 12]: 1.5 instead
/// of 1.25"), a dataset that one file lacks or that has another shape or type, or, where all data are equal,
/// the first byte. Empty if the files are equal. Throws std::runtime_error if a file cannot be opened.
std::string findHdf5Difference(const std::filesystem::path& file, const std::filesystem::path& expected);

}  // namespace twinmap
