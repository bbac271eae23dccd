#pragma once

#include <string>

namespace twinmap::robots {

/// What an element of an MJCF file would have done that is left out; nullptr: MuJoCo compiles it, and what
/// that gives is carried over.
const char* findMjcfEffect(const std::string& element);

}  // namespace twinmap::robots
