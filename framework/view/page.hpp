#pragma once

#include <string>

#include "framework/view/scene.hpp"

namespace twinmap::view {

/// One HTML page that needs nothing else: the mechanism moves, in WebGL; without it, and in print, stands the
/// picture.
std::string makePage(const Scene& scene);

}  // namespace twinmap::view
