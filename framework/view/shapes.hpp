#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// All triangles of a page: with 16 bytes each, and their points, 6 MB, which also software WebGL draws.
constexpr std::size_t kMostTriangles = 200'000;

/// A body's shapes as they are drawn. A mesh of more than `most` triangles is coarser; one that cannot be
/// read is a box as large as the body's ellipsoid. Both add a remark.
std::vector<SceneShape> makeShapes(const BodySpec& body, const Ellipsoid& ellipsoid, std::size_t most,
                                   std::vector<std::string>& remarks);

/// Points of the surface in the shape's frame, whose convex hull is the shape's, or an octagonal one of what
/// is round.
std::vector<Vector> listOutline(const SceneShape& shape);

/// Corners, three by three, on a grid of 65536 steps, or so few that at most `most` triangles are left; low:
/// the grid's origin, size: its edges.
Mesh makeMesh(const std::vector<Vector>& corners, std::size_t most, Vector& low, Vector& size);

}  // namespace twinmap::view
