#pragma once

#include <string>

#include "framework/view/scene.hpp"

namespace twinmap::view {

/// The scene as web/view.js reads it. Numbers of motions have eight digits.
std::string makeSceneJson(const Scene& scene);

}  // namespace twinmap::view
