#include "framework/view/picture.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "framework/base/text/escape.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/view/make_scene.hpp"
#include "framework/view/shapes.hpp"

namespace twinmap::view {
namespace {

struct Point {
  double x, y;
};

/// Directions of the picture's axes in the ground frame.
struct Camera {
  Vector right, up;

  Point project(const Vector& v) const { return {algebra::dot(right, v), -algebra::dot(up, v)}; }
};

constexpr double kWidth = 640.0, kHeight = 480.0, kMargin = 50.0;

bool isPlanar(const Scene& scene, const std::vector<Pose>& poses) {
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

Camera chooseCamera(const Scene& scene, const std::vector<Pose>& poses) {
  if (isPlanar(scene, poses)) {
    return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  }
  const double c = std::sqrt(0.75), s = 0.5;  // 30 degrees to the right, and as much from above
  return {{c, s, 0.0}, {-s * s, c * s, c}};
}

/// The convex hull by Andrew's monotone chain, of points rounded to pixels.
std::vector<Point> findHull(std::vector<Point> points) {
  for (Point& point : points) {
    point = {std::round(point.x), std::round(point.y)};
  }
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Point& point : points) {
      const auto turns_right = [&](const Point& a, const Point& b) {
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

class Drawing {
 public:
  Drawing(const Scene& scene, const std::vector<Pose>& poses)
      : scene_(scene), poses_(poses), camera_(chooseCamera(scene, poses)) {
    fit();
  }

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
  template <class... Values>
  void add(const char* format, const Values&... values) {
    text_ += fmt::format(fmt::runtime(format), values...) + "\n";
  }

  Vector place(int body, const Vector& point) const {
    const Pose& pose = poses_[body];
    return pose.rotation * point + pose.origin;
  }
  Point toPicture(const Vector& v) const {
    const Point p = camera_.project(v);
    return {0.5 * kWidth + scale_ * (p.x - middle_.x), 0.5 * kHeight + scale_ * (p.y - middle_.y)};
  }
  Vector getJoint(std::size_t i) const {
    return place(scene_.bodies[i].parent, scene_.bodies[i].in_parent.origin);
  }

  /// Points of the shapes of a body, in the ground frame.
  std::vector<Vector> listSurface(std::size_t i) const {
    std::vector<Vector> points;
    for (const SceneShape& shape : scene_.bodies[i].shapes) {
      for (const Vector& point : listOutline(shape)) {
        points.push_back(place(static_cast<int>(i), shape.frame.rotation * point + shape.frame.origin));
      }
    }
    return points;
  }

  /// The whole mechanism within the picture.
  void fit() {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    Point low{kInfinite, kInfinite}, high{-kInfinite, -kInfinite};
    const auto include = [&](const Vector& v, double reach) {
      const Point p = camera_.project(v);
      low = {std::min(low.x, p.x - reach), std::min(low.y, p.y - reach)};
      high = {std::max(high.x, p.x + reach), std::max(high.y, p.y + reach)};
    };
    include({}, 0.0);
    for (std::size_t i = 1; i < scene_.bodies.size(); ++i) {
      const Ellipsoid& shape = scene_.bodies[i].ellipsoid;
      include(getJoint(i), 0.0);
      for (const Vector& point : listSurface(i)) {
        include(point, 0.0);
      }
      include(place(static_cast<int>(i), shape.frame.origin),
              std::max({shape.radii.x, shape.radii.y, shape.radii.z}));
    }
    middle_ = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    const double width = std::max(high.x - low.x, 1e-9), height = std::max(high.y - low.y, 1e-9);
    scale_ = std::min((kWidth - 2.0 * kMargin) / width, (kHeight - 2.0 * kMargin) / height);
  }

  /// The outline of an ellipsoid with axes a_k is that of the ellipse with the matrix sum of p_k p_k', p_k
  /// the projections of the axes.
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
          at.x, at.y, std::max(kSmallest, scale_ * std::sqrt(mean + half)),
          std::max(kSmallest, scale_ * std::sqrt(std::max(mean - half, 0.0))), angle, escapeHtml(body.name));
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
  const std::vector<Pose>& poses_;
  Camera camera_;
  Point middle_{};
  double scale_ = 1.0;
  std::string text_;
};

/// Of a model from elsewhere: its outputs over time, one below the other.
std::string drawSignals(const Scene& scene) {
  const Eigen::MatrixXd& outputs = scene.motions.front().outputs;
  const double height = (kHeight - kMargin) / static_cast<double>(std::max<Eigen::Index>(outputs.rows(), 1));
  std::string text;
  for (Eigen::Index i = 0; i < outputs.rows(); ++i) {
    const double low = outputs.row(i).minCoeff(), range = std::max(outputs.row(i).maxCoeff() - low, 1e-300);
    const double bottom = 0.5 * kMargin + height * static_cast<double>(i + 1);
    std::string points;
    for (Eigen::Index k = 0; k < outputs.cols(); ++k) {
      const double share =
          static_cast<double>(k) / static_cast<double>(std::max<Eigen::Index>(outputs.cols() - 1, 1));
      points += fmt::format("{:.0f},{:.1f} ", kMargin + share * (kWidth - 2.0 * kMargin),
                            bottom - (outputs(i, k) - low) / range * (height - 20.0));
    }
    const SceneOutput& output = scene.outputs[static_cast<std::size_t>(i)];
    text += fmt::format("<polyline class=\"signal\" points=\"{}\"/>\n<text x=\"{}\" y=\"{:.1f}\">{}</text>\n",
                        points, kMargin, bottom - height + 14.0,
                        escapeHtml(output.name + (output.unit.empty() ? "" : " [" + output.unit + "]")));
  }
  return text;
}

constexpr const char* kStyle = R"(<style>
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

}  // namespace

std::string makePicture(const Scene& scene) {
  std::string text = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" class="mechanism" viewBox="0 0 {0:.0f} {1:.0f}" role="img" aria-label="{2}">)",
      kWidth, kHeight, escapeHtml("mechanism " + scene.name));
  text += "\n" + std::string(kStyle);
  if (scene.bodies.empty()) {
    text += drawSignals(scene);
  } else {
    text += Drawing(scene, scene.motions.front().poses.front()).draw();
  }
  return text + "</svg>\n";
}

std::string makePicture(const ExperimentSpec& experiment) {
  if (!experiment.trials.empty()) {
    return makePicture(experiment.trials.front().experiment);
  }
  if (experiment.model.source) {
    return "";
  }
  return makePicture(makeStill(experiment, calcBoxCenter(collectSampled(experiment.model))));
}

}  // namespace twinmap::view
