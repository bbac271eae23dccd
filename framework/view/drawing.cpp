#include "framework/view/drawing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "framework/base/text/escape.hpp"
#include "framework/view/shapes.hpp"

namespace twinmap::view {
namespace {

Vector toGround(const Pose& pose, const Vector& point) {
  return pose.rotation * point + pose.origin;
}

Vector findJoint(const Scene& scene, const Poses& poses, std::size_t body) {
  return toGround(poses[scene.bodies[body].parent], scene.bodies[body].in_parent.origin);
}

bool isPlanar(const Scene& scene, const Poses& poses) {
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    const Pose joint = poses[body.parent] * body.in_parent;
    const Vector axis = joint.rotation * body.axis;
    const bool turns = body.joint == "pin" || body.joint == "screw" || body.joint == "cylinder";
    const bool slides = body.joint == "slider";
    if (!(body.joint == "weld" || (turns && std::abs(axis.z) > 1.0 - 1e-9) ||
          (slides && std::abs(axis.z) < 1e-9) || body.joint == "planar")) {
      return false;
    }
  }
  return true;
}

Camera chooseDirections(const Scene& scene, const Poses& poses) {
  if (isPlanar(scene, poses)) {
    return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  }
  const double c = std::sqrt(0.75), s = 0.5;  // 30 degrees to the right, and as much from above
  return {{c, s, 0.0}, {-s * s, c * s, c}};
}

/// The convex hull by Andrew's monotone chain, of points rounded to pixels.
std::vector<Camera::Point> findHull(std::vector<Camera::Point> points) {
  for (Camera::Point& point : points) {
    point = {std::round(point.x), std::round(point.y)};
  }
  std::sort(points.begin(), points.end(), [](const Camera::Point& a, const Camera::Point& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  });
  std::vector<Camera::Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Camera::Point& point : points) {
      const auto turns_right = [&](const Camera::Point& a, const Camera::Point& b) {
        return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) <= 0.0;
      };
      while (hull.size() >= first + 2 && turns_right(hull[hull.size() - 2], hull.back())) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// ": spring, damper".
std::string listActing(const SceneBody& body) {
  std::string text;
  for (const std::string& kind : body.acting) {
    text += (text.empty() ? ": " : ", ") + kind;
  }
  return text;
}

/// Corners of what holds the points seen along the picture's axes.
class Frame {
 public:
  explicit Frame(const Camera& camera) : camera_(camera) {}

  void include(const Vector& v, double reach = 0.0) {
    const Camera::Point p = camera_.project(v);
    low_ = {std::min(low_.x, p.x - reach), std::min(low_.y, p.y - reach)};
    high_ = {std::max(high_.x, p.x + reach), std::max(high_.y, p.y + reach)};
  }

  void include(const Scene& scene, const Poses& poses) {
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
      const Ellipsoid& ellipsoid = scene.bodies[i].ellipsoid;
      include(findJoint(scene, poses, i));
      for (const SceneShape& shape : scene.bodies[i].shapes) {
        for (const Vector& point : listOutline(shape)) {
          include(toGround(poses[i], toGround(shape.frame, point)));
        }
      }
      include(toGround(poses[i], ellipsoid.frame.origin),
              std::max({ellipsoid.radii.x, ellipsoid.radii.y, ellipsoid.radii.z}));
    }
  }

  Camera fill() const {
    Camera camera = camera_;
    camera.middle = {0.5 * (low_.x + high_.x), 0.5 * (low_.y + high_.y)};
    const double width = std::max(high_.x - low_.x, 1e-9), height = std::max(high_.y - low_.y, 1e-9);
    camera.scale = std::min((kPictureWidth - 2.0 * kPictureMargin) / width,
                            (kPictureHeight - 2.0 * kPictureMargin) / height);
    return camera;
  }

 private:
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const Camera& camera_;
  Camera::Point low_{kInfinite, kInfinite}, high_{-kInfinite, -kInfinite};
};

class Drawing {
 public:
  Drawing(const Scene& scene, const Camera& camera, const Poses& poses)
      : scene_(scene), camera_(camera), poses_(poses) {}

  std::string draw() {
    for (std::size_t i = 1; i < scene_.bodies.size(); ++i) {
      drawBody(i);
    }
    for (const SceneLine& line : scene_.lines) {
      drawLine(line.kind, place(line.from, line.from_point), place(line.to, line.to_point));
    }
    for (std::size_t i = 1; i < scene_.bodies.size(); ++i) {
      drawJoint(i);
    }
    for (const SceneMark& mark : scene_.marks) {
      const Point at = toPicture(place(mark.body, mark.point));
      add(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="4"><title>{}</title></circle>)", mark.kind, at.x,
          at.y, escapeHtml(mark.name.empty() ? mark.kind : mark.name));
    }
    return text_;
  }

 private:
  using Point = Camera::Point;

  template <class... Values>
  void add(const char* format, const Values&... values) {
    text_ += fmt::format(fmt::runtime(format), values...) + "\n";
  }

  Vector place(int body, const Vector& point) const {
    return toGround(poses_[static_cast<std::size_t>(body)], point);
  }
  Point toPicture(const Vector& v) const { return camera_.toPicture(v); }
  Vector getJoint(std::size_t i) const { return findJoint(scene_, poses_, i); }

  /// The outline of an ellipsoid with axes a_k is the ellipse with the matrix sum of p_k p_k', p_k the
  /// projections of the axes.
  void drawBody(std::size_t i) {
    const SceneBody& body = scene_.bodies[i];
    const Vector& radii = body.ellipsoid.radii;
    const auto& axes = body.ellipsoid.frame.rotation;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    const std::array<Vector, 3> all{algebra::scale(radii.x, axes.x), algebra::scale(radii.y, axes.y),
                                    algebra::scale(radii.z, axes.z)};
    for (const Vector& axis : all) {
      const Point p = camera_.project(poses_[i].rotation * axis);
      xx += p.x * p.x;
      xy += p.x * p.y;
      yy += p.y * p.y;
    }
    const double mean = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy) * 180.0 / std::acos(-1.0);
    const Vector center = place(static_cast<int>(i), body.ellipsoid.frame.origin);
    const Point at = toPicture(center), joint = toPicture(getJoint(i));
    add(R"(<line class="link" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", joint.x, joint.y, at.x,
        at.y);
    for (const SceneShape& shape : body.shapes) {
      drawShape(i, shape);
    }
    if (body.has_mass || !body.shapes.empty()) {
      add(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", at.x + 6.0, at.y - 6.0, escapeHtml(body.name));
    }
    if (body.has_mass && body.shapes.empty()) {
      constexpr double kSmallest = 2.0;  // pixels
      add(R"svg(<ellipse class="body" cx="{0:.1f}" cy="{1:.1f}" rx="{2:.1f}" ry="{3:.1f}" transform="rotate({4:.1f} {0:.1f} {1:.1f})"><title>{5}</title></ellipse>)svg",
          at.x, at.y, std::max(kSmallest, camera_.scale * std::sqrt(mean + half)),
          std::max(kSmallest, camera_.scale * std::sqrt(std::max(mean - half, 0.0))), angle,
          escapeHtml(body.name));
    }
  }

  /// The convex hull of what is seen of it.
  void drawShape(std::size_t i, const SceneShape& shape) {
    std::vector<Point> points;
    for (const Vector& point : listOutline(shape)) {
      points.push_back(
          toPicture(place(static_cast<int>(i), shape.frame.rotation * point + shape.frame.origin)));
    }
    std::string corners;
    for (const Point& corner : findHull(std::move(points))) {
      corners += fmt::format("{:.0f},{:.0f} ", corner.x, corner.y);
    }
    add(R"(<polygon class="body" points="{}"><title>{}</title></polygon>)", corners,
        escapeHtml(scene_.bodies[i].name));
  }

  void drawJoint(std::size_t i) {
    const SceneBody& body = scene_.bodies[i];
    if (body.joint == "weld") {
      return;
    }
    const Vector origin = getJoint(i);
    const Point at = toPicture(origin);
    const Vector axis = poses_[body.parent].rotation * (body.in_parent.rotation * body.axis);
    const Point along = camera_.project(axis);
    constexpr double kLength = 18.0;  // pixels, of an axis in the picture's plane
    add(R"(<line class="axis" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", at.x - kLength * along.x,
        at.y - kLength * along.y, at.x + kLength * along.x, at.y + kLength * along.y);
    add(R"(<circle class="joint" cx="{:.1f}" cy="{:.1f}" r="4"><title>{} of {}{}</title></circle>)", at.x,
        at.y, body.joint, escapeHtml(body.name), listActing(body));
  }

  void drawLine(const std::string& kind, const Vector& from, const Vector& to) {
    const Point a = toPicture(from), b = toPicture(to);
    add(R"(<line class="{}" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", kind, a.x, a.y, b.x, b.y);
  }

  const Scene& scene_;
  const Camera& camera_;
  const Poses& poses_;
  std::string text_;
};

}  // namespace

const char* const kPictureStyle = R"(<style>
.mechanism { color: #222; background: #fff; font: 12px sans-serif; }
.mechanism text { fill: currentColor; }
.mechanism .body { fill: #4c78a8; fill-opacity: .25; stroke: #4c78a8; stroke-width: 1.5; }
.mechanism .link { stroke: currentColor; stroke-width: 2; stroke-linecap: round; opacity: .5; }
.mechanism .joint { fill: #fff; stroke: #e45756; stroke-width: 2; }
.mechanism .axis { stroke: #e45756; stroke-width: 1.5; stroke-dasharray: 4 3; }
.mechanism .spring { stroke: #54a24b; stroke-width: 2; stroke-dasharray: 6 3; }
.mechanism .damper { stroke: #b279a2; stroke-width: 2; stroke-dasharray: 2 2; }
.mechanism .rod { stroke: currentColor; stroke-width: 2; }
.mechanism .signal { fill: none; stroke: #4c78a8; stroke-width: 1.5; }
.mechanism .force { fill: #f58518; }
.mechanism .sensor { fill: #72b7b2; }
.mechanism .constraint { fill: none; stroke: #eeca3b; stroke-width: 2; }
.mechanism .contact { fill: #9d755d; }
@media (prefers-color-scheme: dark) { .mechanism { color: #ddd; background: #181818; } .mechanism .joint { fill: #181818; } }
</style>
)";

Camera fitCamera(const Scene& scene, const std::vector<const Poses*>& shown) {
  const Camera directions = chooseDirections(scene, *shown.front());
  Frame frame(directions);
  frame.include({});
  for (const Poses* poses : shown) {
    frame.include(scene, *poses);
  }
  return frame.fill();
}

std::string drawMechanism(const Scene& scene, const Camera& camera, const Poses& poses) {
  return Drawing(scene, camera, poses).draw();
}

}  // namespace twinmap::view
