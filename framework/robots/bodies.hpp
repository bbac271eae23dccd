#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/robots/inertia.hpp"

namespace twinmap::robots {

enum class Base { kFixed, kFree };

/// A link with mass as a body of an experiment. A link without mass is a frame of the body that it is fixed
/// to; where a joint moves it, the joint moves the first body that is fixed to it. Where there is none, but
/// joints begin there, it is a body without mass.
struct Body {
  const Link* link = nullptr;
  std::string parent;            ///< the link of another body, or "": the ground
  const Joint* joint = nullptr;  ///< that moves it; none: welded, or the free base
  bool is_free_base = false;
  bool on_ground = false;  ///< whether nothing moves it
  bool massless = false;   ///< a frame between joints
  Pose in_parent, in_body;
};

/// Where a link is: the body that it moves with (its link; none: the ground), and its frame in that body's.
struct Place {
  const Link* body = nullptr;
  Pose frame;
};

struct Assembly {
  std::vector<Body> bodies;
  std::map<std::string, Place> places;  ///< of all links
};

/// Bodies in an order in which parents come first, each link's children in that of the file. `moving`: names
/// of the joints that move, empty for all; others stay at 0. Throws ExperimentError with the line for links
/// that are no tree, a moving link that has no mass and carries none, and mimics in a circle or of a joint
/// that does not move.
Assembly assembleBodies(const Robot& robot, Base base, const std::vector<std::string>& moving);

}  // namespace twinmap::robots
