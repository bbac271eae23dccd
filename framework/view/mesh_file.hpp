#pragma once

#include <string>

#include "framework/view/mesh_corners.hpp"

namespace twinmap::view {

/// The triangles of an STL (binary or text), an OBJ, whose polygons are fans, or a Collada file (.dae).
/// Throws std::runtime_error with the file and why it cannot be read, or is larger than kLargestMesh.
Corners readMeshFile(const std::string& path);

}  // namespace twinmap::view
