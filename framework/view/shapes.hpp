#pragma once

#include <string>
#include <vector>

#include "framework/experiment/experiment_spec.hpp"
#include "framework/view/scene.hpp"

namespace twinmap::view {

/// All triangles of a page: with 16 bytes each, and their points, 6 MB, which also software WebGL draws.
constexpr std::size_t kMostTriangles = 200'000;

/// A body's shapes as they are drawn. A mesh that cannot be read is a box as large as the body's ellipsoid,
/// which adds a remark.
std::vector<SceneShape> makeShapes(const BodySpec& body, const Ellipsoid& ellipsoid,
                                   std::vector<std::string>& remarks);

/// Makes all meshes coarser, by the same share, until they have at most `most` triangles together; says so.
void limitTriangles(std::size_t most, std::vector<SceneBody>& bodies, std::vector<std::string>& remarks);

/// Points of the surface in the shape's frame, whose convex hull is the shape's, or an octagonal one of what
/// is round.
std::vector<Vector> listOutline(const SceneShape& shape);

}  // namespace twinmap::view
