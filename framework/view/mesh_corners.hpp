#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace twinmap::view {

/// Corners of triangles, three by three, in the file's own unit; of Collada in m.
using Corners = std::vector<std::array<double, 3>>;

constexpr std::size_t kLargestMesh = 100'000'000;  ///< bytes; drawing it takes 0.4 GB of memory

}  // namespace twinmap::view
