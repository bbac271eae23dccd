#pragma once

#include <string>

namespace twinmap::robots {

/// What becomes of an element ("robot/link/visual") or attribute ("robot/joint/limit@effort") of a URDF.
struct UrdfKey {
  const char* path;
  const char* effect;  ///< of what is left out: what it would have done; nullptr: it is carried over
};

/// The key of a path; nullptr: not of URDF.
const UrdfKey* findUrdfKey(const std::string& path);

}  // namespace twinmap::robots
