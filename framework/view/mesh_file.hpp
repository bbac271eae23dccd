#pragma once

#include <array>
#include <string>
#include <vector>

namespace twinmap::view {

/// Corners of triangles, three by three, in the file's own unit; of Collada in m.
using Corners = std::vector<std::array<double, 3>>;

/// The triangles of an STL (binary or text), an OBJ, whose polygons are fans, or a Collada file (.dae).
/// Throws std::runtime_error with the file and why it cannot be read, or is larger than kLargestMesh.
Corners readMeshFile(const std::string& path);

constexpr std::size_t kLargestMesh = 100'000'000;  ///< bytes; drawing it takes 0.4 GB of memory

}  // namespace twinmap::view
