#pragma once

#include <string>

#include "framework/view/mesh_corners.hpp"

namespace twinmap::view {

/// The triangles of a Collada file's scene, in m by its <unit>. Its <up_axis> does not turn them: RViz, whose
/// view of a URDF is the one that its authors saw, ignores it. Polygons are fans; holes are filled, materials
/// and the poses of skins are not read. `bytes` are used up. Throws std::runtime_error with the file and why
/// it cannot be read.
Corners readCollada(std::string bytes, const std::string& path);

}  // namespace twinmap::view
