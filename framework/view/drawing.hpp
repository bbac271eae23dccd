#pragma once

#include <string>
#include <vector>

#include "framework/view/scene.hpp"

namespace twinmap::view {

constexpr double kPictureWidth = 640.0, kPictureHeight = 480.0, kPictureMargin = 50.0;  ///< pixels

/// Colours and strokes of the class "mechanism", light or dark as the reader's screen is.
extern const char* const kPictureStyle;

/// Bodies, ground first, at one instant.
using Poses = std::vector<Pose>;

/// How points of the ground frame come into a picture.
struct Camera {
  struct Point {
    double x, y;
  };
  Vector right, up;    ///< directions of the picture's axes in the ground frame
  Point middle{};      ///< of what is shown, in m
  double scale = 1.0;  ///< pixels a metre

  Point project(const Vector& v) const { return {algebra::dot(right, v), -algebra::dot(up, v)}; }
  Point toPicture(const Vector& v) const {
    const Point p = project(v);
    return {0.5 * kPictureWidth + scale * (p.x - middle.x), 0.5 * kPictureHeight + scale * (p.y - middle.y)};
  }
};

/// All of the mechanism at all of `shown` is within the picture. Seen from the front right above, or along z
/// where all joints turn about z.
Camera fitCamera(const Scene& scene, const std::vector<const Poses*>& shown);

/// The mechanism as elements of SVG: bodies as the outlines of their ellipsoids or shapes, joints, lines and
/// marks.
std::string drawMechanism(const Scene& scene, const Camera& camera, const Poses& poses);

}  // namespace twinmap::view
