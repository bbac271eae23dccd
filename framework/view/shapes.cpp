#include "framework/view/shapes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "framework/view/mesh_file.hpp"

namespace twinmap::view {
namespace {

constexpr double kSteps = 65535.0;

Vector toVector(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

double divide(double value, double by) {
  return by > 0.0 ? value / by : 0.0;
}

/// Points that fall on one node of the grid become one, and triangles that lose a corner vanish.
Mesh cluster(const std::vector<Vector>& corners, const Vector& low, const Vector& size, double nodes) {
  Mesh mesh;
  std::map<std::array<std::uint16_t, 3>, std::uint32_t> places;
  std::set<std::array<std::uint32_t, 3>> known;
  std::array<std::uint32_t, 3> triangle{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector from = corners[i] - low;
    const auto step = [&](double share) {
      return static_cast<std::uint16_t>(std::lround(std::round(share * nodes) / nodes * kSteps));
    };
    const std::array<std::uint16_t, 3> point{step(divide(from.x, size.x)), step(divide(from.y, size.y)),
                                             step(divide(from.z, size.z))};
    const auto [place, is_new] = places.emplace(point, static_cast<std::uint32_t>(mesh.points.size()));
    if (is_new) {
      mesh.points.push_back(point);
    }
    triangle[i % 3] = place->second;
    const bool is_whole =
        triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0];
    if (i % 3 == 2 && is_whole && known.insert(triangle).second) {
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

SceneShape readMesh(const ShapeSpec& spec) {
  std::vector<Vector> corners;
  for (const auto& corner : readMeshFile(spec.mesh->text)) {
    corners.push_back({corner[0] * spec.scale[0], corner[1] * spec.scale[1], corner[2] * spec.scale[2]});
  }
  if (spec.scale[0] * spec.scale[1] * spec.scale[2] < 0.0) {  // or the mirror image would show its inside
    std::reverse(corners.begin(), corners.end());
  }
  Vector low = corners.front(), high = low;
  for (const Vector& corner : corners) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y), std::min(low.z, corner.z)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y), std::max(high.z, corner.z)};
  }
  SceneShape shape{"mesh", {}, high - low};
  shape.frame.origin = low;
  shape.mesh = cluster(corners, low, shape.size, kSteps);
  shape.file = spec.mesh->text;
  if (shape.mesh.triangles.empty()) {
    throw std::runtime_error(shape.file + ": its triangles have no area");
  }
  return shape;
}

/// Its nodes become fewer until at most `most` triangles are left, or a cube of two.
void coarsen(Mesh& mesh, std::size_t most) {
  constexpr double kFirst = 1000.0, kFewer = 0.8;
  std::vector<Vector> corners;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const auto& point = mesh.points[corner];
      corners.push_back({point[0] / kSteps, point[1] / kSteps, point[2] / kSteps});
    }
  }
  for (double nodes = kFirst; mesh.triangles.size() > most && nodes >= 2.0;
       nodes = std::floor(kFewer * nodes)) {
    mesh = cluster(corners, {}, {1.0, 1.0, 1.0}, nodes);
  }
}

/// In the place of a mesh, in the body's frame.
SceneShape makeBox(const Ellipsoid& ellipsoid) {
  constexpr double kUnknown = 0.1;  // m, of a body without an extent
  const double widest = std::max({ellipsoid.radii.x, ellipsoid.radii.y, ellipsoid.radii.z});
  const auto edge = [&](double radius) {
    return widest > 0.0 ? 2.0 * std::max(radius, 0.1 * widest) : kUnknown;
  };
  return {
      "box", ellipsoid.frame, {edge(ellipsoid.radii.x), edge(ellipsoid.radii.y), edge(ellipsoid.radii.z)}};
}

Vector measureRound(const RoundShapeSpec& spec) {
  return {2.0 * spec.radius, 2.0 * spec.radius, spec.length};
}

SceneShape makeShape(const ShapeSpec& spec) {
  if (spec.mesh) {
    return readMesh(spec);
  }
  if (spec.box) {
    return {"box", {}, toVector(*spec.box)};
  }
  if (spec.sphere) {
    return {"sphere", {}, {2.0 * *spec.sphere, 2.0 * *spec.sphere, 2.0 * *spec.sphere}};
  }
  return spec.cylinder ? SceneShape{"cylinder", {}, measureRound(*spec.cylinder)}
                       : SceneShape{"capsule", {}, measureRound(*spec.capsule)};
}

void addCircle(double radius, double z, std::vector<Vector>& points) {
  constexpr int kCorners = 24;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::acos(-1.0) * i / kCorners;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
}

/// Circles of latitude of a half sphere beyond z.
void addCap(double radius, double z, std::vector<Vector>& points) {
  constexpr int kCircles = 6;
  for (int i = 0; i <= kCircles; ++i) {
    const double angle = 0.5 * std::acos(-1.0) * i / kCircles;
    addCircle(radius * std::cos(angle), z + std::copysign(radius * std::sin(angle), z), points);
  }
}

}  // namespace

std::vector<SceneShape> makeShapes(const BodySpec& body, const Ellipsoid& ellipsoid,
                                   std::vector<std::string>& remarks) {
  std::vector<SceneShape> shapes;
  for (const ShapeSpec& spec : body.shapes) {
    try {
      shapes.push_back(makeShape(spec));
      const Pose place{algebra::rotateXyz(toVector(spec.orientation)), toVector(spec.point)};
      shapes.back().frame = place * shapes.back().frame;
    } catch (const std::runtime_error& error) {
      remarks.push_back(std::string(error.what()) + "; a box is drawn in its place");
      shapes.push_back(makeBox(ellipsoid));
    }
  }
  return shapes;
}

void limitTriangles(std::size_t most, std::vector<SceneBody>& bodies, std::vector<std::string>& remarks) {
  std::size_t all = 0;
  for (const SceneBody& body : bodies) {
    for (const SceneShape& shape : body.shapes) {
      all += shape.mesh.triangles.size();
    }
  }
  for (SceneBody& body : bodies) {
    for (SceneShape& shape : body.shapes) {
      const std::size_t count = shape.mesh.triangles.size();
      if (count > 0 && all > most) {
        coarsen(shape.mesh, most * count / all);
        remarks.push_back(fmt::format("{}: is drawn with {} of its {} triangles", shape.file,
                                      shape.mesh.triangles.size(), count));
      }
    }
  }
}

std::vector<Vector> listOutline(const SceneShape& shape) {
  std::vector<Vector> points;
  const Vector& size = shape.size;
  if (shape.kind == "mesh") {
    for (const auto& point : shape.mesh.points) {
      points.push_back({point[0] / kSteps * size.x, point[1] / kSteps * size.y, point[2] / kSteps * size.z});
    }
  } else if (shape.kind == "box") {
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [&](int bit, double edge) { return (corner & bit) != 0 ? 0.5 * edge : -0.5 * edge; };
      points.push_back({side(1, size.x), side(2, size.y), side(4, size.z)});
    }
  } else {
    for (const double end : {-0.5, 0.5}) {
      const double z = shape.kind == "sphere" ? std::copysign(0.0, end) : end * size.z;
      shape.kind == "cylinder" ? addCircle(0.5 * size.x, z, points) : addCap(0.5 * size.x, z, points);
    }
  }
  return points;
}

}  // namespace twinmap::view
