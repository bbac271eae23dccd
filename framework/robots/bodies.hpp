#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/robots/inertia.hpp"

namespace twinmap::robots {

enum class Base { kFixed, kFree };

/// A link with mass as a body of an experiment. A link without mass is a frame of the body that it is fixed
/// to; where a joint moves it, the joint moves the first body that is fixed to it.
struct Body {
  const Link* link = nullptr;
  std::string parent;            ///< the link of another body, or "": the ground
  const Joint* joint = nullptr;  ///< that moves it; none: welded, or the free base
  bool is_free_base = false;
  bool on_ground = false;  ///< whether nothing moves it
  Pose in_parent, in_body;
};

/// In an order in which parents come first, each link's children in that of the file. `moving`: names of the
/// joints that move, empty for all; others stay at 0. Throws ExperimentError with the line for links that are
/// no tree, a moving link that no mass is fixed to, and mimics in a circle or of a joint that does not move.
std::vector<Body> assembleBodies(const Robot& robot, Base base, const std::vector<std::string>& moving);

}  // namespace twinmap::robots
