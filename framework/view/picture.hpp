#pragma once

#include <string>

#include "framework/view/scene.hpp"

namespace twinmap::view {

/// The mechanism at its first instant as SVG, light or dark as the reader's screen is: bodies as the outlines
/// of their ellipsoids, joints, lines and marks. Seen from the front right above, or along z where all joints
/// turn about z.
std::string makePicture(const Scene& scene);

}  // namespace twinmap::view
