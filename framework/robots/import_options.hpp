#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/robots/bodies.hpp"
#include "framework/robots/recording.hpp"

namespace twinmap::robots {

struct ImportOptions {
  Base base = Base::kFixed;
  std::vector<std::string> parameters;   ///< inertia, friction, armature, damping
  std::vector<std::string> joints;       ///< that move; empty: all
  std::optional<Recording> recording{};  ///< whose columns are called as coordinates and signals
  bool from_motion = false;              ///< the motion is known, and what drives exert is measured
  bool stops = false;                    ///< limits of joints become rigid stops
  double relative_stddev = 0.2;          ///< of the parameters' priors
};

}  // namespace twinmap::robots
